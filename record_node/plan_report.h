// record_node/plan_report.h -- what `cordis check` says of a session, made while it is recorded.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace cordis::record {

/// The command that reports on the plan of a session. Empty without a launch file.
/// @param overrides  words that are laid on the file: `clock=lockstep`
std::vector<std::string> plan_command(const std::string& launch_file,
                                      const std::vector<std::string>& overrides);

/// The output of a process beside the session, whose loops have the processor first. Without that
/// process, or when it fails, there is none.
class PlanReport {
 public:
  /// @param command  the process and its words; empty: none
  explicit PlanReport(const std::vector<std::string>& command);
  /// Ends the process.
  ~PlanReport();
  PlanReport(const PlanReport&) = delete;
  PlanReport& operator=(const PlanReport&) = delete;

  /// The report, once, when it is made within this time.
  std::optional<std::string> take(std::chrono::milliseconds at_most);
  /// True if the process still works.
  bool is_under_way() const noexcept { return process_ > 0; }

 private:
  bool has_ended(std::chrono::milliseconds at_most) noexcept;

  int output_ = -1;  // a file in memory
  pid_t process_ = 0;
  int status_ = 0;
};

}  // namespace cordis::record
