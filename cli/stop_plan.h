// cli/stop_plan.h -- in which order, and how patiently, the processes of a session are stopped.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

namespace cordis::cli {

/// Stops processes stage after stage: all of a stage are asked to stop, and killed when they have
/// not after 2 s; then comes the next stage. Four stages of processes that do not listen still end
/// within kLongestStop, because every stage leaves kShareOfLater to each of those that follow.
/// Knows time only by what it is told.
class StopPlan {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kPatience{2000};
  static constexpr std::chrono::milliseconds kLongestStop{4500};
  static constexpr std::chrono::milliseconds kShareOfLater{500};

  struct Action {
    std::size_t process;
    bool kill;  ///< else: ask
  };

  /// @param stages  of each process; the smallest stops first
  explicit StopPlan(std::vector<int> stages) : stages_(std::move(stages)) {}

  void begin(Time now) noexcept;
  bool begun() const noexcept { return begun_.has_value(); }

  /// What is to be done now, given which processes still run. Each action is told once.
  std::vector<Action> due(Time now, const std::vector<bool>& running);

  /// When due() will have something to say even if no process ends meanwhile.
  std::optional<Time> deadline() const noexcept { return deadline_; }

 private:
  std::optional<int> first_running_stage(const std::vector<bool>& running) const;
  Time deadline_of(int stage, Time now) const;

  std::vector<int> stages_;
  std::optional<Time> begun_;
  std::optional<int> stage_;      // the one that was asked
  std::optional<Time> deadline_;  // when it is killed; none once it was
};

}  // namespace cordis::cli
