// node/line_output.h -- writes lines, and never waits for who reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace cordis::node {

/// A file that takes whole lines. A terminal that is stopped or a pipe that is not read must not
/// stop who writes: what cannot be written waits, and past `max_waiting` lines are dropped and
/// counted.
class LineOutput {
 public:
  /// @param max_waiting  [bytes]; up to 64 KiB of them are set aside at once
  LineOutput(int file, std::size_t max_waiting);
  /// Writes what waits, but gives up on a reader that takes nothing for a second.
  ~LineOutput();
  LineOutput(const LineOutput&) = delete;
  LineOutput& operator=(const LineOutput&) = delete;

  /// Adds a line (without newline) and writes as much as goes without waiting.
  void line(std::string_view text);
  /// Lines that never came to line(): they count as dropped.
  void count_lost(std::uint64_t count) noexcept { dropped_ += count; }
  /// Writes as much as goes without waiting.
  void flush();

 private:
  /// @return whether some was written.
  bool write_some(int patience_msec);

  int file_;
  std::size_t max_waiting_;
  std::string waiting_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cordis::node
