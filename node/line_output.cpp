// node/line_output.cpp
#include "node/line_output.h"

#include <algorithm>
#include <cerrno>

#include <poll.h>
#include <unistd.h>

#include "node/config/count_text.h"

namespace cordis::node {
namespace {

constexpr int kLastPatience = 1000;     // [ms]
constexpr std::size_t kPortion = 4096;  // [bytes] that a pipe which is ready takes without blocking
constexpr std::size_t kMaxSetAside = 65536;  // [bytes]

}  // namespace

LineOutput::LineOutput(int file, std::size_t max_waiting) : file_(file), max_waiting_(max_waiting) {
  waiting_.reserve(std::min(max_waiting, kMaxSetAside));
}

LineOutput::~LineOutput() {
  while (write_some(kLastPatience)) {
  }
}

void LineOutput::line(std::string_view text) {
  if (dropped_ > 0) flush();  // room for this one
  if (waiting_.size() + text.size() > max_waiting_) {
    ++dropped_;
    return;
  }
  if (dropped_ > 0) {
    waiting_ += "... " + config::count_text(dropped_, "line is", "lines are") +
                " missing here: they were not read in time\n";
    dropped_ = 0;
  }
  waiting_ += text;
  waiting_ += '\n';
  flush();
}

void LineOutput::flush() {
  while (write_some(0)) {
  }
}

bool LineOutput::write_some(int patience_msec) {
  pollfd file{file_, POLLOUT, 0};
  if (waiting_.empty() || poll(&file, 1, patience_msec) != 1) return false;
  const ssize_t count = write(file_, waiting_.data(), std::min(waiting_.size(), kPortion));
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  // No process will ever read again: forget it all.
  waiting_.erase(0, count < 0 ? waiting_.size() : static_cast<std::size_t>(count));
  return true;
}

}  // namespace cordis::node
