// cli/run/respawn_policy.h -- when a node that died starts again, and when no more.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

namespace cordis::cli {

/// The restarts of one node: each waits longer than the one before it, and there are at most
/// kMaxPerMinute within a minute. A node that has run for a minute starts again as the first time.
/// Its only clock is the time that its caller passes.
class RespawnPolicy {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::array<std::chrono::milliseconds, 3> kDelays{
      std::chrono::milliseconds(200), std::chrono::milliseconds(1000),
      std::chrono::milliseconds(5000)};  ///< before the first, the second, every further restart
  static constexpr std::size_t kMaxPerMinute = 5;
  static constexpr std::chrono::seconds kWindow{60};

  /// Records a death. @return when the node starts again; nothing when it has been started
  /// kMaxPerMinute times in the last minute.
  std::optional<Time> died(Time now);

 private:
  std::deque<Time> restarts_;  // of the last minute
};

}  // namespace cordis::cli
