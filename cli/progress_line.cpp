// cli/progress_line.cpp
#include "cli/progress_line.h"

#include <cstdio>

#include <unistd.h>

#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr auto kWithoutTerminal = std::chrono::seconds(10);
constexpr const char* kBegin = "\r\033[K";  // clears the line

}  // namespace

ProgressLine::ProgressLine() : is_terminal_(isatty(STDERR_FILENO) == 1), last_(Clock::now()) {}

void ProgressLine::show(const std::string& text) {
  if (is_terminal_) {
    std::fprintf(stderr, "%s%s", kBegin, node::terminal_text(text).c_str());
    std::fflush(stderr);
    is_open_ = true;
    return;
  }
  if (Clock::now() < last_ + kWithoutTerminal) return;
  last_ = Clock::now();
  std::fprintf(stderr, "%s\n", node::terminal_text(text).c_str());
}

void ProgressLine::end() {
  if (is_open_) std::fputc('\n', stderr);
  is_open_ = false;
}

void ProgressLine::clear() {
  if (is_open_) std::fputs(kBegin, stderr);
  is_open_ = false;
}

}  // namespace cordis::cli
