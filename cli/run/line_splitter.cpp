// cli/run/line_splitter.cpp
#include "cli/run/line_splitter.h"

namespace cordis::cli {

void LineSplitter::feed(std::string_view bytes, const Sink& sink) {
  while (!bytes.empty()) {
    const std::size_t room = kLongestLine - begun_.size();
    const std::size_t newline = bytes.substr(0, room + 1).find('\n');
    const bool whole = newline != std::string_view::npos;
    const std::size_t length = whole ? newline : std::min(room, bytes.size());
    begun_ += bytes.substr(0, length);
    bytes.remove_prefix(length + (whole ? 1 : 0));
    if (whole || (begun_.size() == kLongestLine && !bytes.empty())) {
      sink(begun_);
      begun_.clear();
    }
  }
}

void LineSplitter::finish(const Sink& sink) {
  if (!begun_.empty()) sink(begun_);
  begun_.clear();
}

}  // namespace cordis::cli
