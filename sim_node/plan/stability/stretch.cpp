// sim_node/plan/stability/stretch.cpp
#include "sim_node/plan/stability/stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "sim_node/plan/stability/law_energy.h"

namespace cordis::plan {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

double scale_of(double rest_length, const Reach& reach) {
  constexpr double kSmallest = 1e-3;  // [m]
  return std::max({reach.elongation, std::abs(rest_length), kSmallest});
}

/// How far a tension gives way [m]; infinite when it has not taken everything up at `farthest`.
/// @param tension  over the way, against it [N]
/// @param last     the way ends there [m]
template <class Tension>
double way_of(const Tension& tension, const Reach& reach, double scale, double farthest,
              double last) {
  constexpr double kGrowth = 1.05;
  constexpr double kSmallest = 1e-9;  // scales
  const double energy = energy_at(reach);
  double stored = 0.0;
  double before = 0.0;
  for (double way = kSmallest * scale; way < farthest; way *= kGrowth) {
    const double reached = std::min(way, last);
    stored += 0.5 * (tension(before) + tension(reached)) * (reached - before);
    if (stored >= energy + work_of_forces(reach, reached) || reached >= last) return reached;
    before = reached;
  }
  return kNowhere;
}

}  // namespace

Stretch stretch_within(const engine::LinkState& state, double rest_length, bool turns,
                       const Reach& reach) {
  constexpr double kFarthest = 1e3;        // scales
  constexpr double kFarthestPower = 1e12;  // what rises like a power takes everything up in the end
  const double scale = scale_of(rest_length, reach);
  const auto* power = std::get_if<engine::Power>(&state.elasticity);
  const bool rises = power != nullptr && power->coefficient > 0.0;
  const double farthest = (rises ? kFarthestPower : kFarthest) * scale;
  const auto way = [&](double sign, double last) {
    const auto tension = [&](double argument) {
      const double e = sign * argument;
      const Interval law = tension_between(state.elasticity, e + rest_length, e, reach);
      return sign * state.stiffness * e + (sign > 0.0 ? law.low : -law.high);
    };
    return way_of(tension, reach, scale, farthest, last);
  };
  Stretch stretch;
  stretch.longer = way(1.0, kNowhere);
  stretch.shorter = way(-1.0, turns ? std::max(rest_length, 0.0) : kNowhere);
  for (double* one : {&stretch.longer, &stretch.shorter}) {
    stretch.confined = stretch.confined && std::isfinite(*one);
    if (!std::isfinite(*one) || reach.held)
      *one = std::max(scale, std::isfinite(*one) ? *one : 0.0);
  }
  return stretch;
}

Interval elongations_within(const engine::LinkState& state, double rest_length,
                            const Reach& reach) {
  if (reach.held) return kAnyNumber;
  constexpr double kFarthest = 1e3;  // scales
  const double scale = scale_of(rest_length, reach);
  const auto way = [&](double sign) {
    const auto tension = [&](double argument) {
      const Interval held = tension_at(state, rest_length + sign * argument, rest_length, reach);
      return sign > 0.0 ? held.low : -held.high;
    };
    return way_of(tension, reach, scale, kFarthest * scale, kNowhere);
  };
  return {-way(-1.0), way(1.0)};
}

}  // namespace cordis::plan
