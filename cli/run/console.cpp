// cli/run/console.cpp
#include "cli/run/console.h"

#include <cstdlib>

#include <unistd.h>

namespace cordis::cli {

Console::Console(std::array<int, 2> files)
    : outputs_{node::LineOutput(files[0], kMaxWaiting), node::LineOutput(files[1], kMaxWaiting)} {}

void Console::line(Stream stream, std::string_view text) {
  outputs_[static_cast<std::size_t>(stream)].line(text);
}

void Console::flush() {
  for (node::LineOutput& output : outputs_) output.flush();
}

bool wants_colours(Stream stream, bool refused) {
  return !refused && std::getenv("NO_COLOR") == nullptr &&
         isatty(stream == Stream::kOut ? 1 : 2) != 0;
}

}  // namespace cordis::cli
