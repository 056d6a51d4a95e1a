// cli/run/stop_plan.h -- in which order, and how patiently, the processes of a session are stopped.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

namespace cordis::cli {

/// Stops processes stage after stage: all of a stage are asked to stop, and killed when they have
/// not after 2 s; then comes the next stage. Four stages of processes that do not listen still end
/// within kLongestStop, because every stage leaves kShareOfLater to each of those that follow.
/// In a hurry all are killed at once, except processes that drive motors: those are asked, and
/// killed after kLastFade.
/// Knows time only by what it is given.
class StopPlan {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kPatience{2000};
  static constexpr std::chrono::milliseconds kLongestStop{4500};
  static constexpr std::chrono::milliseconds kShareOfLater{500};
  static constexpr std::chrono::milliseconds kLastFade{500};

  struct Action {
    std::size_t process;
    bool kill;  ///< else: ask
  };

  /// @param stages         of each process; the smallest stops first
  /// @param drives_motors  of each process; empty: none does
  explicit StopPlan(std::vector<int> stages, std::vector<bool> drives_motors = {});

  void begin(Time now) noexcept;
  bool begun() const noexcept { return begun_.has_value(); }

  /// Ends all now; begins the plan if that has not been done.
  void hurry(Time now) noexcept;
  bool hurried() const noexcept { return hurried_.has_value(); }

  /// What is to be done now, given which processes still run. Each action is reported once.
  std::vector<Action> due(Time now, const std::vector<bool>& running);

  /// When due() will have something to say even if no process ends meanwhile.
  std::optional<Time> deadline() const noexcept { return deadline_; }

 private:
  std::optional<int> first_running_stage(const std::vector<bool>& running) const;
  Time deadline_of(int stage, Time now) const;
  std::vector<Action> due_in_a_hurry(Time now, const std::vector<bool>& running);

  std::vector<int> stages_;
  std::vector<bool> drives_motors_;
  std::optional<Time> begun_;
  std::optional<Time> hurried_;
  bool hurry_done_ = false;       // the first actions of a hurry have been given
  std::optional<int> stage_;      // the one that was asked
  std::optional<Time> deadline_;  // when it is killed; none once it was
};

}  // namespace cordis::cli
