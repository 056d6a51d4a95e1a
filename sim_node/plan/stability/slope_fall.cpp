// sim_node/plan/stability/slope_fall.cpp
#include "sim_node/plan/stability/slope_fall.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "sim_node/plan/stability/law_energy.h"

namespace cordis::plan {
namespace {

using Places = std::vector<double>;

/// Elongations to look at, ascending: even ones, ones that are denser towards the rest, and corners of a table.
Places places_of(const engine::LinkState& state, double rest_length, const Interval& within,
                 double scale) {
  constexpr int kEven = 100;
  constexpr double kDenser = 0.9;
  constexpr double kNearest = 1e-6;
  constexpr double kFarthest = 1e3;  // scales
  constexpr double kApart = 1e-9;    // of the distance: nearer places differ by rounding
  double farthest = kFarthest * scale;
  Places corners;
  if (const auto* table = std::get_if<engine::Table>(&state.elasticity)) {
    corners = table->argument();
    for (const double corner : {corners.front(), corners.back()})
      farthest = std::max(farthest, 2.0 * std::abs(corner));
  }
  const double low = std::max(within.low, -farthest);
  const double high = std::min(within.high, farthest);
  Places all{low, high};
  for (const double end : {low, high}) {
    for (int i = 0; i < kEven; ++i) all.push_back(end * i / kEven);
    for (double share = 1.0; share > kNearest; share *= kDenser) all.push_back(end * share);
  }
  for (const double corner : corners) {
    if (corner > low && corner < high) all.push_back(corner);
  }
  std::ranges::sort(all);
  const auto is_near = [&](double a, double b) {
    return b - a <= kApart * (std::abs(rest_length) + std::abs(b));
  };
  all.erase(std::unique(all.begin(), all.end(), is_near), all.end());
  return all;
}

/// The fall of a slope along the places, where the force opposes this way or is none.
/// @param tension  at each place: above 0 where it opposes the way [N]
double fall_along(const Places& way, const Places& tension) {
  double fall = 0.0;
  double steepest = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    if (tension[i - 1] < 0.0 || tension[i] < 0.0) {
      steepest = 0.0;
      continue;
    }
    const double slope = (tension[i] - tension[i - 1]) / (way[i] - way[i - 1]);
    if (!std::isfinite(slope)) continue;
    steepest = std::max(steepest, slope);
    fall = std::max(fall, steepest - slope);
  }
  return fall;
}

/// The larger fall of the two ways, of one tension for each place [N].
double fall_both_ways(Places way, Places tension) {
  const double longer = fall_along(way, tension);
  for (Places* one : {&way, &tension}) {
    std::ranges::reverse(*one);
    for (double& value : *one) value = -value;
  }
  return std::max(longer, fall_along(way, tension));
}

/// The variables of a reach, each held at one place of its range.
/// @param share  of the range, 0 to 1
Reach held_at(const Reach& reach, double share) {
  constexpr double kLargest = 1.0;  // of what has no bound
  auto held = std::make_shared<std::vector<Interval>>(*reach.variables);
  for (Interval& range : *held) {
    const double low = std::isfinite(range.low) ? range.low : std::min(-kLargest, range.high);
    const double high = std::isfinite(range.high) ? range.high : std::max(kLargest, range.low);
    range.low = range.high = low + (high - low) * share;
  }
  Reach there = reach;
  there.variables = std::move(held);
  return there;
}

double fall_with(const engine::LinkState& state, double rest_length, const Places& places,
                 const Reach& reach) {
  Places low;
  Places high;
  for (const double elongation : places) {
    const Interval tension = tension_at(state, rest_length + elongation, rest_length, reach);
    low.push_back(tension.low);
    high.push_back(tension.high);
  }
  return std::max(fall_both_ways(places, low), fall_both_ways(places, high));
}

bool reaches_limit(const engine::LinkState& state, double rest_length, const Places& places,
                   const Reach& reach) {
  constexpr double kRounding = 1e-9;
  if (!std::isfinite(state.force_limit)) return false;
  return std::ranges::any_of(places, [&](double elongation) {
    const Interval tension = tension_at(state, rest_length + elongation, rest_length, reach);
    return std::max(-tension.low, tension.high) >= state.force_limit * (1.0 - kRounding);
  });
}

}  // namespace

double slope_fall(const engine::LinkState& state, double rest_length, const Interval& within,
                  double largest, const Reach& reach) {
  constexpr double kSmallest = 1e-3;  // [m]
  const double scale = std::max({reach.elongation, std::abs(rest_length), kSmallest});
  const bool has_limit = std::isfinite(state.force_limit);
  if (is_none(state.elasticity) && !has_limit) return 0.0;
  const Places places = places_of(state, rest_length, within, scale);
  double fall = reaches_limit(state, rest_length, places, reach) ? largest : 0.0;
  if (std::holds_alternative<engine::LennardJones>(state.elasticity) ||
      std::holds_alternative<engine::Rings>(state.elasticity))
    return fall;
  if (!engine::asks_for_variable(state.elasticity) || reach.variables == nullptr)
    return std::max(fall, fall_with(state, rest_length, places, reach));
  for (const double share : {0.0, 0.5, 1.0})
    fall = std::max(fall, fall_with(state, rest_length, places, held_at(reach, share)));
  return fall;
}

}  // namespace cordis::plan
