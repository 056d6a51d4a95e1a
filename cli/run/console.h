// cli/run/console.h -- writes for a person, and never waits for them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "cli/run/child.h"
#include "node/line_output.h"

namespace cordis::cli {

/// stdout and stderr of the program, in whole lines; who does not read them does not stop the
/// processes whose output is shown.
class Console {
 public:
  static constexpr std::size_t kMaxWaiting = 1 << 20;  ///< [bytes] per stream

  /// @param files  where the two streams go
  explicit Console(std::array<int, 2> files = {1, 2});

  /// Adds a line (without newline) and writes as much as goes without waiting.
  void line(Stream stream, std::string_view text);
  /// Writes as much as goes without waiting.
  void flush();

 private:
  std::array<node::LineOutput, 2> outputs_;
};

/// True if output to this stream is to be coloured: it is a terminal, NO_COLOR is not set, and
/// `refused` is false.
bool wants_colours(Stream stream, bool refused);

}  // namespace cordis::cli
