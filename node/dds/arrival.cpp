// node/dds/arrival.cpp
#include "node/dds/arrival.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "node/dds/sample_socket.h"
#include "node/processor_time.h"
#include "node/time.h"

namespace cordis::dds {
namespace {

constexpr timespec kLittle{0, 50'000};  // for what another thread delivers

/// A thread waits at the socket for as long as this lives.
class Attendance {
 public:
  explicit Attendance(const std::shared_ptr<PresentSocket>& present) noexcept
      : socket_(present == nullptr ? nullptr : present->get()) {
    if (socket_ != nullptr) socket_->begin_wait();
  }
  ~Attendance() {
    if (socket_ == nullptr) return;
    socket_->end_wait();
    if (leaves_) socket_->leave();
  }
  Attendance(const Attendance&) = delete;
  Attendance& operator=(const Attendance&) = delete;

  /// Takes a datagram, and hands it to DDS.
  SampleSocket::Taken receive() noexcept {
    const SampleSocket::Taken taken = take();
    if (taken == SampleSocket::Taken::kDatagram) deliver();
    return taken;
  }
  SampleSocket::Taken take() noexcept {
    return socket_ == nullptr ? SampleSocket::Taken::kNothing : socket_->take();
  }
  void deliver() noexcept { socket_->deliver(); }
  void leave() noexcept { leaves_ = true; }
  int file() const noexcept { return socket_ == nullptr ? -1 : socket_->file(); }

 private:
  std::shared_ptr<SampleSocket> socket_;
  bool leaves_ = false;
};

}  // namespace

Arrival::Arrival() : woken_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (woken_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Arrival::~Arrival() {
  close(woken_);
}

void Arrival::attach(std::shared_ptr<PresentSocket> socket) noexcept {
  socket_ = std::move(socket);
}

void Arrival::announce() noexcept {
  count_.fetch_add(1);
  if (is_awaited_.load()) eventfd_write(woken_, 1);
}

void Arrival::update() noexcept {
  if (socket_ == nullptr) return;
  Attendance attendance(socket_);
  for (int n = 0; n < kMaxOfAnUpdate; ++n) {
    if (attendance.receive() != SampleSocket::Taken::kDatagram) return;
  }
  attendance.leave();
}

bool Arrival::wait_until(std::uint32_t seen, std::int64_t until_nsec) noexcept {
  Attendance attendance(socket_);
  // Announced before this thread sleeps: the count has changed. Later: is_awaited_ is seen.
  is_awaited_.store(true);
  std::int64_t left = 1;
  while (count_.load() == seen && left > 0) {
    left = std::max<std::int64_t>(until_nsec - node::monotonic_nsec(), 0);
    const timespec limit{left / 1'000'000'000, left % 1'000'000'000};
    std::array<pollfd, 2> files{pollfd{woken_, POLLIN, 0}, pollfd{attendance.file(), POLLIN, 0}};
    if (ppoll(files.data(), files.size(), &limit, nullptr) <= 0) break;
    eventfd_t announced = 0;
    if (files[0].revents != 0) eventfd_read(woken_, &announced);
    // What this thread delivers it need not be woken for.
    is_awaited_.store(false);
    const bool is_busy = attendance.receive() == SampleSocket::Taken::kBusy;
    is_awaited_.store(true);
    // The thread that is at the socket needs a processor, of which there may be one.
    if (is_busy && count_.load() == seen) ppoll(files.data(), 1, &kLittle, nullptr);
  }
  is_awaited_.store(false);
  return count() != seen;
}

bool Arrival::poll_until(std::uint32_t seen, std::int64_t until_nsec) noexcept {
  constexpr int kPausesPerPoll = 20;  // at the clock and the socket
  Attendance attendance(socket_);
  bool is_over = false;
  while (count() == seen && !is_over) {
    const std::int64_t begun = node::thread_processor_nsec();
    SampleSocket::Taken taken = SampleSocket::Taken::kNothing;
    while (count() == seen && !is_over && taken != SampleSocket::Taken::kDatagram) {
      for (int i = 0; i < kPausesPerPoll; ++i) __builtin_ia32_pause();
      taken = attendance.take();
      is_over = node::monotonic_nsec() >= until_nsec;
    }
    polled_nsec_ += node::thread_processor_nsec() - begun;
    if (taken == SampleSocket::Taken::kDatagram) attendance.deliver();
  }
  return count() != seen;
}

}  // namespace cordis::dds
