// node/dds/sample_socket.h -- the socket of samples of a participant, for a loop that waits for
// them itself. Included by node/dds and its tests alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>

namespace cordis::dds {

/// The UDP socket on which a participant receives samples. Any thread may take a datagram from it
/// and hand it to DDS; one at a time does so. A loop that waits for its samples takes them itself, so
/// no other thread has to be woken between the datagram and the loop.
class SampleSocket {
 public:
  using Receiver = eprosima::fastdds::rtps::TransportReceiverInterface;
  using Locator = eprosima::fastrtps::rtps::Locator_t;

  /// @param locator         where DDS expects the samples
  /// @param receiver        what hands a datagram to DDS; not used after detach()
  /// @param buffer_bytes    that the kernel is to keep
  /// @param longest_bytes   of a datagram
  /// @param is_secured      of the participant
  /// @throws std::system_error when the port cannot be bound.
  SampleSocket(const std::string& address, const Locator& locator, Receiver& receiver,
               std::uint32_t buffer_bytes, std::uint32_t longest_bytes, bool is_secured = false);
  ~SampleSocket();
  SampleSocket(const SampleSocket&) = delete;
  SampleSocket& operator=(const SampleSocket&) = delete;

  int file() const noexcept { return file_; }

  enum class Taken : std::uint8_t {
    kNothing,   ///< no datagram waits
    kDatagram,  ///< this thread calls deliver() next; no other thread takes one until then
    kBusy       ///< another thread takes or delivers one
  };
  /// Takes a datagram out of the socket. Never blocks.
  [[nodiscard]] Taken take() noexcept;
  /// Hands the datagram taken last to DDS, as far as it may be read. DDS calls the listeners of its readers.
  void deliver() noexcept;

  /// A loop waits here, and takes what comes. It does so again within kAttended, or another thread
  /// takes its place.
  void begin_wait() noexcept;
  void end_wait() noexcept;
  /// More has come than the loop takes: another thread takes the rest.
  void leave() noexcept;
  static constexpr std::int64_t kAttended = 20'000'000;  // [ns]
  /// True while a loop waits, and for kAttended after that.
  bool is_attended() const noexcept;

  /// DDS receives nothing any more.
  void detach() noexcept;

 private:
  int file_ = -1;
  const bool is_secured_;
  const std::uint32_t longest_;  // [bytes] of a datagram
  Locator locator_;
  std::mutex mutex_;  // of the next four; held from take() to deliver()
  Receiver* receiver_;
  std::vector<std::uint8_t> datagram_;
  std::uint32_t size_ = 0;
  Locator sender_;
  std::atomic<bool> is_awaited_{false};
  std::atomic<std::int64_t> attended_nsec_;
};

/// The socket of samples that a participant has at present: another one after it joins again.
class PresentSocket {
 public:
  std::shared_ptr<SampleSocket> get() const noexcept {
    const std::lock_guard lock(mutex_);
    return socket_;
  }
  void set(std::shared_ptr<SampleSocket> socket) noexcept {
    const std::lock_guard lock(mutex_);
    if (socket_ != nullptr) socket_->leave();
    socket_.swap(socket);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<SampleSocket> socket_;
};

}  // namespace cordis::dds
