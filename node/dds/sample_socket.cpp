// node/dds/sample_socket.cpp
#include "node/dds/sample_socket.h"

#include <cerrno>
#include <limits>
#include <system_error>

#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/datagram_filter.h"
#include "node/dds/udp_address.h"
#include "node/dds/udp_locator.h"
#include "node/time.h"

namespace cordis::dds {

namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min() / 2;

}  // namespace

SampleSocket::SampleSocket(const std::string& address, const Locator& locator, Receiver& receiver,
                           std::uint32_t buffer_bytes, std::uint32_t longest_bytes, bool is_secured)
    : file_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
      is_secured_(is_secured),
      longest_(longest_bytes),
      locator_(locator),
      receiver_(&receiver),
      datagram_(longest_bytes + kBehindFragments),
      attended_nsec_(kNever) {
  const int bytes = static_cast<int>(buffer_bytes);
  setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  const sockaddr_in place = udp_address(static_cast<std::uint16_t>(locator.port), ipv4_of(address));
  if (bind(file_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) return;
  const int error = errno;
  close(file_);
  throw std::system_error(error, std::generic_category(),
                          address + ":" + std::to_string(locator.port));
}

SampleSocket::~SampleSocket() {
  close(file_);
}

SampleSocket::Taken SampleSocket::take() noexcept {
  if (!mutex_.try_lock()) return Taken::kBusy;
  sockaddr_in from{};
  socklen_t from_size = sizeof from;
  const ssize_t size = recvfrom(file_, datagram_.data(), longest_, MSG_DONTWAIT,
                                reinterpret_cast<sockaddr*>(&from), &from_size);
  if (size <= 0 || receiver_ == nullptr) {
    mutex_.unlock();
    return Taken::kNothing;
  }
  size_ = static_cast<std::uint32_t>(size);
  set_udp_address(sender_, from);
  return Taken::kDatagram;
}

void SampleSocket::deliver() noexcept {
  const std::uint32_t bytes = bytes_to_read(datagram_.data(), size_, is_secured_);
  if (bytes > 0) receiver_->OnDataReceived(datagram_.data(), bytes, locator_, sender_);
  mutex_.unlock();
}

void SampleSocket::begin_wait() noexcept {
  is_awaited_.store(true, std::memory_order_relaxed);
}

void SampleSocket::end_wait() noexcept {
  attended_nsec_.store(node::monotonic_nsec(), std::memory_order_relaxed);
  is_awaited_.store(false, std::memory_order_release);
}

void SampleSocket::leave() noexcept {
  attended_nsec_.store(kNever, std::memory_order_relaxed);
}

bool SampleSocket::is_attended() const noexcept {
  if (is_awaited_.load(std::memory_order_acquire)) return true;
  const std::int64_t ago = node::monotonic_nsec() - attended_nsec_.load(std::memory_order_relaxed);
  return ago < kAttended;
}

void SampleSocket::detach() noexcept {
  const std::lock_guard lock(mutex_);
  receiver_ = nullptr;
}

}  // namespace cordis::dds
