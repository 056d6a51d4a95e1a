// node/tick_cost.cpp
#include "node/tick_cost.h"

#include <fmt/format.h>

namespace cordis::node {

std::string TickCost::text_of(std::int64_t used_nsec, std::uint64_t ticks, double polled_s) {
  if (ticks == 0) return {};
  const double per_tick = 1e6 / static_cast<double>(ticks);
  const double used_us = static_cast<double>(used_nsec) * 1e-9 * per_tick;
  const double polled_us = polled_s * per_tick;
  const std::string text = fmt::format("processor time of a tick: {:.1f} us", used_us - polled_us);
  return polled_s > 0.0 ? text + fmt::format(", and {:.1f} us of polling", polled_us) : text;
}

}  // namespace cordis::node
