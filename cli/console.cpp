// cli/console.cpp
#include "cli/console.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include <poll.h>
#include <unistd.h>

#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

constexpr int kLastPatience = 1000;     // [ms]
constexpr std::size_t kPortion = 4096;  // [bytes] that a pipe which is ready takes without blocking

}  // namespace

Console::~Console() {
  for (const Stream stream : {Stream::kOut, Stream::kError}) {
    while (write_some(stream, kLastPatience)) {
    }
  }
}

void Console::line(Stream stream, std::string_view text) {
  Pending& pending = pending_[static_cast<std::size_t>(stream)];
  if (pending.text.size() + text.size() > kMostWaiting) {
    ++pending.dropped;
    return;
  }
  if (pending.dropped > 0) {
    pending.text += "... " + config::count_text(pending.dropped, "line is", "lines are") +
                    " missing here: nobody read them in time\n";
    pending.dropped = 0;
  }
  pending.text += text;
  pending.text += '\n';
  while (write_some(stream, 0)) {
  }
}

void Console::flush() {
  for (const Stream stream : {Stream::kOut, Stream::kError}) {
    while (write_some(stream, 0)) {
    }
  }
}

bool Console::write_some(Stream stream, int patience_msec) {
  const auto index = static_cast<std::size_t>(stream);
  std::string& text = pending_[index].text;
  pollfd file{files_[index], POLLOUT, 0};
  if (text.empty() || poll(&file, 1, patience_msec) != 1) return false;
  const ssize_t count = write(files_[index], text.data(), std::min(text.size(), kPortion));
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  // Nobody will ever read again: forget it all.
  text.erase(0, count < 0 ? text.size() : static_cast<std::size_t>(count));
  return true;
}

bool wants_colours(Stream stream, bool refused) {
  return !refused && std::getenv("NO_COLOR") == nullptr &&
         isatty(stream == Stream::kOut ? 1 : 2) != 0;
}

}  // namespace cordis::cli
