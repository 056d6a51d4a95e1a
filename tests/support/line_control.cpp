// tests/support/line_control.cpp
#include "tests/support/line_control.h"

#include <algorithm>

#include <poll.h>
#include <unistd.h>

#include "tests/support/pseudo_terminal.h"

namespace cordis::test {
namespace {

std::int64_t clock_nsec() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

}  // namespace

LineControl::LineControl()
    : board_(open_board_end()), node_(open_node_end(board_)), thread_([this] { run(); }) {}

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
