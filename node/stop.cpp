// node/stop.cpp
#include "node/stop.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <stdexcept>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace cordis::node {
namespace {

// A signal handler may touch only these: a lock-free flag, and an event file that wakes every
// poll().
std::atomic<bool> stop_wanted{false};
int event_file = -1;

void on_signal(int) {
  request_stop();
}

}  // namespace

void install_stop_signals() {
  event_file = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (event_file < 0) throw std::runtime_error("cannot create an event file");
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // not under nohup
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

bool stop_requested() noexcept {
  return stop_wanted.load(std::memory_order_relaxed);
}

void request_stop() noexcept {
  const int saved_errno = errno;
  stop_wanted.store(true);
  const std::uint64_t one = 1;
  if (event_file >= 0 && write(event_file, &one, sizeof one) < 0) {
    // Full means that it is readable already.
  }
  errno = saved_errno;
}

bool wait_for_stop(std::chrono::nanoseconds at_most) noexcept {
  if (stop_requested()) return true;
  pollfd wanted{event_file, POLLIN, 0};
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  const timespec limit{seconds.count(), (at_most - seconds).count()};
  ppoll(&wanted, 1, &limit, nullptr);
  return stop_requested();
}

}  // namespace cordis::node
