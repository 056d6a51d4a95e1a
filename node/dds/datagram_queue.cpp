// node/dds/datagram_queue.cpp
#include "node/dds/datagram_queue.h"

#include <algorithm>
#include <cerrno>

#include <sys/socket.h>

namespace cordis::dds {

bool send_datagram(int file, const std::uint8_t* datagram, std::uint32_t size,
                   const sockaddr_in& address) noexcept {
  const ssize_t sent = sendto(file, datagram, size, MSG_NOSIGNAL | MSG_DONTWAIT,
                              reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return sent == static_cast<ssize_t>(size) || (sent < 0 && errno == EAGAIN);
}

DatagramQueue::DatagramQueue(int file)
    : file_(file), ring_(std::make_unique_for_overwrite<Datagram[]>(kRoom)) {}  // NOLINT

bool DatagramQueue::put(const std::uint8_t* datagram, std::uint32_t size,
                        const sockaddr_in& address) noexcept {
  const std::uint64_t put = put_.load(std::memory_order_relaxed);
  if (size > kLongest || put - sent_.load(std::memory_order_acquire) == kRoom) {
    const std::lock_guard lock(sending_);
    send_waiting();
    return send_datagram(file_, datagram, size, address);
  }
  Datagram& one = ring_[put % kRoom];
  one.address = address;
  one.size = size;
  std::copy_n(datagram, size, one.bytes.begin());
  put_.store(put + 1, std::memory_order_release);
  return true;
}

std::uint64_t DatagramQueue::flush() noexcept {
  const std::lock_guard lock(sending_);
  return send_waiting();
}

std::uint64_t DatagramQueue::send_waiting() noexcept {
  const std::uint64_t put = put_.load(std::memory_order_acquire);
  const std::uint64_t begun = sent_.load(std::memory_order_relaxed);
  for (std::uint64_t n = begun; n < put; ++n) {
    const Datagram& one = ring_[n % kRoom];
    send_datagram(file_, one.bytes.data(), one.size, one.address);
    sent_.store(n + 1, std::memory_order_release);
  }
  return put - begun;
}

}  // namespace cordis::dds
