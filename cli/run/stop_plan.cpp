// cli/run/stop_plan.cpp
#include "cli/run/stop_plan.h"

#include <algorithm>
#include <set>
#include <utility>

namespace cordis::cli {

StopPlan::StopPlan(std::vector<int> stages, std::vector<bool> drives_motors)
    : stages_(std::move(stages)), drives_motors_(std::move(drives_motors)) {
  drives_motors_.resize(stages_.size(), false);
}

void StopPlan::begin(Time now) noexcept {
  if (!begun_) begun_ = now;
}

void StopPlan::hurry(Time now) noexcept {
  begin(now);
  if (!hurried_) hurried_ = now;
}

std::optional<int> StopPlan::first_running_stage(const std::vector<bool>& running) const {
  std::optional<int> first;
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    if (running[i] && (!first || stages_[i] < *first)) first = stages_[i];
  }
  return first;
}

StopPlan::Time StopPlan::deadline_of(int stage, Time now) const {
  const std::set<int> distinct(stages_.begin(), stages_.end());
  const auto later = std::distance(distinct.upper_bound(stage), distinct.end());
  const Time shared = *begun_ + kLongestStop - kShareOfLater * later;
  return std::min(now + kPatience, shared);
}

std::vector<StopPlan::Action> StopPlan::due(Time now, const std::vector<bool>& running) {
  if (hurried_) return due_in_a_hurry(now, running);
  std::vector<Action> actions;
  const std::optional<int> stage = first_running_stage(running);
  if (!begun_ || !stage) return actions;

  const auto act_on_stage = [&](bool kill) {
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      if (running[i] && stages_[i] == *stage) actions.push_back({i, kill});
    }
  };
  if (stage_ != stage) {
    stage_ = stage;
    deadline_ = deadline_of(*stage, now);
    act_on_stage(/*kill=*/false);
  } else if (deadline_ && now >= *deadline_) {
    deadline_.reset();
    act_on_stage(/*kill=*/true);
  }
  return actions;
}

std::vector<StopPlan::Action> StopPlan::due_in_a_hurry(Time now, const std::vector<bool>& running) {
  std::vector<Action> actions;
  const bool first = !std::exchange(hurry_done_, true);
  if (first) deadline_ = *hurried_ + kLastFade;
  const bool last = deadline_ && now >= *deadline_;
  if (last) deadline_.reset();
  for (std::size_t i = 0; i < running.size(); ++i) {
    if (running[i] && (first || last)) actions.push_back({i, last || !drives_motors_[i]});
  }
  return actions;
}

}  // namespace cordis::cli
