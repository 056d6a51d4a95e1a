// cli/run/respawn_policy.cpp
#include "cli/run/respawn_policy.h"

#include <algorithm>

namespace cordis::cli {

std::optional<RespawnPolicy::Time> RespawnPolicy::died(Time now) {
  while (!restarts_.empty() && restarts_.front() + kWindow <= now) restarts_.pop_front();
  if (restarts_.size() >= kMaxPerMinute) return std::nullopt;
  const std::size_t step = std::min(restarts_.size(), kDelays.size() - 1);
  restarts_.push_back(now + kDelays[step]);
  return restarts_.back();
}

}  // namespace cordis::cli
