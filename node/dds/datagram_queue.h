// node/dds/datagram_queue.h -- datagrams that another thread sends. Included by node/dds and its
// tests alone.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include <netinet/in.h>

namespace cordis::dds {

/// Sends a datagram, now, and never blocks: where the socket has no room, it is lost as in a network.
/// @return false when the socket does not take such a datagram
bool send_datagram(int file, const std::uint8_t* datagram, std::uint32_t size,
                   const sockaddr_in& address) noexcept;

/// Datagrams for those who only observe a force loop. The loop copies them here, which costs no
/// system call. A thread that is in no hurry sends them, in the order in which they came. None is
/// lost: one that has no room is sent at once, after those before it.
class DatagramQueue {
 public:
  static constexpr std::uint32_t kLongest = 1500;  // [bytes] of one that is copied
  static constexpr std::uint64_t kRoom = 1024;     // datagrams

  /// Reserves 1.6 MB; memory that no datagram has used takes no room.
  /// @param file  the socket that sends; it outlives the queue
  explicit DatagramQueue(int file);
  DatagramQueue(const DatagramQueue&) = delete;
  DatagramQueue& operator=(const DatagramQueue&) = delete;

  /// One thread at a time puts. Allocates nothing.
  /// @return false when it was sent at once, and the socket did not take it
  [[nodiscard]] bool put(const std::uint8_t* datagram, std::uint32_t size,
                         const sockaddr_in& address) noexcept;

  /// Sends what waits; any thread. @return the number of datagrams
  std::uint64_t flush() noexcept;

 private:
  struct Datagram {
    sockaddr_in address;
    std::uint32_t size;
    std::array<std::uint8_t, kLongest> bytes;
  };

  std::uint64_t send_waiting() noexcept;

  int file_;
  std::unique_ptr<Datagram[]> ring_;    // NOLINT(modernize-avoid-c-arrays)
  std::atomic<std::uint64_t> put_{0};   // datagrams so far
  std::atomic<std::uint64_t> sent_{0};  // likewise
  std::mutex sending_;                  // of who sends
};

}  // namespace cordis::dds
