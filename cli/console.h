// cli/console.h -- writes for a person, and never waits for them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "cli/child.h"

namespace cordis::cli {

/// stdout and stderr of the program, in whole lines. A terminal that is stopped or a pipe that
/// nobody reads must not stop the processes whose output is shown: what cannot be written waits,
/// and past kMostWaiting lines are dropped and counted.
class Console {
 public:
  static constexpr std::size_t kMostWaiting = 1 << 20;  ///< [bytes] per stream

  /// @param files  where the two streams go
  explicit Console(std::array<int, 2> files = {1, 2}) : files_(files) {}
  /// Writes what waits, but gives up on a reader that takes nothing for a second.
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Adds a line (without newline) and writes as much as goes without waiting.
  void line(Stream stream, std::string_view text);
  /// Writes as much as goes without waiting.
  void flush();

 private:
  struct Pending {
    std::string text;
    std::uint64_t dropped = 0;
  };
  /// @return whether some was written.
  bool write_some(Stream stream, int patience_msec);

  std::array<int, 2> files_;
  std::array<Pending, 2> pending_;
};

/// Whether output to this stream is to be coloured: it is a terminal, NO_COLOR is not set, and
/// `refused` is false.
bool wants_colours(Stream stream, bool refused);

}  // namespace cordis::cli
