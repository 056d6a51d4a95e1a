// node/time_scale.h -- slow motion of a realtime session.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace cordis::node {

/// Seconds of simulated time per second that a session may be asked for with `rate`.
inline constexpr double kSlowestTimeScale = 0.01;
inline constexpr double kFullTimeScale = 1.0;

/// True for the drivers of device_node whose devices live in simulated time: they follow slow
/// motion. Any other driver moves something real.
constexpr bool is_simulated_driver(std::string_view driver) noexcept {
  constexpr std::array<std::string_view, 4> kSimulated{"mock", "script", "replay", "pointer"};
  return std::ranges::find(kSimulated, driver) != kSimulated.end();
}

}  // namespace cordis::node
