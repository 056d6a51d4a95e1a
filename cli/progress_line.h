// cli/progress_line.h -- one line about how far a long job is.
#pragma once

#include <chrono>
#include <string>

namespace cordis::cli {

/// Writes on stderr: on a terminal the line replaces the one before, elsewhere one comes every 10 s.
class ProgressLine {
 public:
  ProgressLine();

  /// @param text  the whole line, without its end
  void show(const std::string& text);
  /// Ends the line of the terminal, before other text.
  void end();
  /// Takes the line of the terminal away.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool is_terminal_;
  bool is_open_ = false;
  Clock::time_point last_;
};

}  // namespace cordis::cli
