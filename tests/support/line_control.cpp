// tests/support/line_control.cpp
#include "tests/support/line_control.h"

#include <algorithm>
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace cordis::test {
namespace {

std::int64_t clock_nsec() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

}  // namespace

LineControl::LineControl() {
  board_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_EQ(grantpt(board_), 0);
  EXPECT_EQ(unlockpt(board_), 0);
  node_ = ::open(ptsname(board_), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  EXPECT_GE(node_, 0);
  termios line{};
  tcgetattr(node_, &line);
  cfmakeraw(&line);
  tcsetattr(node_, TCSANOW, &line);
  thread_ = std::thread([this] { run(); });
}

LineControl::~LineControl() {
  ends_ = true;
  thread_.join();
  close(node_);
  close(board_);
}

void LineControl::run() noexcept {
  while (!ends_) {
    const std::int64_t sent_nsec = clock_nsec();
    sent_nsec_ = sent_nsec;
    char byte = 'a';
    if (::write(node_, &byte, 1) != 1) return;  // its byte never arrives
    while (!ends_ && ::read(board_, &byte, 1) != 1) {
      pollfd arrival{board_, POLLIN, 0};
      poll(&arrival, 1, 10);
    }
    if (ends_) return;
    worst_nsec_ = std::max(worst_nsec_.load(), clock_nsec() - sent_nsec);
    sent_nsec_ = 0;
    ++bytes_;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::chrono::nanoseconds LineControl::worst() const noexcept {
  const std::int64_t sent_nsec = sent_nsec_;
  const std::int64_t on_its_way = sent_nsec == 0 ? 0 : clock_nsec() - sent_nsec;
  return std::chrono::nanoseconds(std::max(worst_nsec_.load(), on_its_way));
}

}  // namespace cordis::test
