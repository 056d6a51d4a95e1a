// cli/run/output_watcher.h -- keeps what processes print, and ends them when they take too long.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cli/run/supervisor.h"

namespace cordis::cli {

/// Watches processes whose output is read when they have ended. Ctrl-C and `longest` end them.
class OutputWatcher : public Watcher {
 public:
  /// @param count    processes
  /// @param longest  they may take
  OutputWatcher(std::size_t count, std::chrono::seconds longest);

  void line(std::size_t process, Stream stream, std::string_view text) override;
  bool ended(std::size_t process, const Ending& ending, bool stopping) override;
  void killed(std::size_t process) override;
  void interrupted(bool again) override;
  bool tick() override;

  /// @return the lines of both streams of `process`, in the order in which they came
  const std::string& output(std::size_t process) const;
  bool is_interrupted() const noexcept { return interrupted_; }
  bool is_late() const noexcept { return late_; }

 private:
  std::vector<std::string> outputs_;
  std::chrono::steady_clock::time_point deadline_;
  bool interrupted_ = false;
  bool late_ = false;
};

}  // namespace cordis::cli
