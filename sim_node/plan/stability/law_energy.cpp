// sim_node/plan/stability/law_energy.cpp
#include "sim_node/plan/stability/law_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/start_point.h"

namespace cordis::plan {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kNothing = 1e-9;  // of a force, beside the largest there is

/// True if a law that is 0 somewhere has its least potential there: it pulls what is longer and pushes
/// what is shorter, or pushes alone.
bool never_falls(const engine::Law& law) {
  if (is_none(law)) return true;
  if (const auto* power = std::get_if<engine::Power>(&law)) return power->coefficient >= 0.0;
  if (const auto* rings = std::get_if<engine::Rings>(&law)) {
    return std::ranges::all_of(rings->rings,
                               [](const auto& ring) { return ring.stiffness >= 0.0; });
  }
  const auto* table = std::get_if<engine::Table>(&law);
  if (table == nullptr) return false;
  const auto tension = [&](double elongation) {
    return elastic_tension(law, {elongation, elongation});
  };
  for (const double elongation : table->argument()) {
    if (tension(elongation) * elongation < 0.0) return false;
  }
  return tension(0.0) == 0.0 && tension(table->argument().front()) <= 0.0 &&
         tension(table->argument().back()) >= 0.0;
}

/// Distances between which a law is summed up, from one on to an end, near each other at first.
class Way {
 public:
  Way(const engine::LinkState& state, double rest_length, const Reach& reach)
      : state_(state), rest_length_(rest_length), reach_(reach) {
    if (const auto* table = std::get_if<engine::Table>(&state.elasticity)) {
      for (const double elongation : table->argument())
        corners_.push_back(rest_length + elongation);
    } else if (const auto* rings = std::get_if<engine::Rings>(&state.elasticity)) {
      for (const auto& ring : rings->rings) corners_.push_back(ring.radius);
    }
  }

  /// The most that the potential falls on the way [J].
  double fall(double from, double to) const {
    double energy = 0.0;
    double most = 0.0;
    double before = from;
    double outwards_before = outwards(from, to);
    for (const double distance : places(from, to)) {
      const double here = outwards(distance, to > from ? kEndless : -kEndless);
      energy += 0.5 * (outwards_before + here) * std::abs(distance - before);
      most = std::max(most, energy);
      before = distance;
      outwards_before = here;
    }
    return most;
  }

  /// The force at a distance that drives it on towards a side [N].
  double outwards(double distance, double side) const {
    const Interval tension = tension_at(state_, distance, rest_length_, reach_);
    const double force = side > distance ? -tension.low : tension.high;
    return std::isfinite(force) ? force : 0.0;
  }

 private:
  std::vector<double> places(double from, double to) const {
    constexpr int kEven = 400;
    std::vector<double> all;
    for (int i = 1; i <= kEven; ++i) all.push_back(from + (to - from) * i / kEven);
    for (double share = 1.0; share > 1e-6; share *= 0.9) all.push_back(from + (to - from) * share);
    const bool approaches = std::abs(to) < std::abs(from);  // laws of the distance are steep near 0
    for (double share = 0.97; approaches && share > 1e-9; share *= 0.97) {
      all.push_back(to + (from - to) * share);
    }
    for (const double corner : corners_) {
      if ((corner - from) * (corner - to) < 0.0) all.push_back(corner);
    }
    std::ranges::sort(all);
    if (to < from) std::ranges::reverse(all);
    return all;
  }

  const engine::LinkState& state_;
  double rest_length_;
  const Reach& reach_;
  std::vector<double> corners_;
};

/// How a force goes on without an end.
struct Tail {
  bool endless = false;      // its potential falls without an end
  bool ever_harder = false;  // it grows
};

/// @param side  1 towards larger distances, else -1
Tail tail_of(const Way& way, double scale, double side) {
  constexpr int kPlaces = 16;
  constexpr double kNear = 1e2;
  constexpr double kFar = 1e3;
  double first = 0.0;
  double last = 0.0;
  double largest = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double away = kNear * scale * std::pow(kFar / kNear, i / (kPlaces - 1.0));
    last = way.outwards(side * away, side * kEndless);
    if (i == 0) first = last;
    if (!(last > 0.0)) return {};
    largest = std::max(largest, last);
  }
  // What falls as the inverse of the distance, or slower, sums up without an end.
  const bool endless = last * kFar > 0.5 * first * kNear && last > kNothing * largest;
  return {endless, last > 2.0 * first};
}

double scale_of(double distance, double rest_length, const engine::LinkState& state) {
  constexpr double kSmallest = 1e-3;  // [m]
  double scale = std::max({std::abs(distance), std::abs(rest_length), kSmallest});
  if (const auto* table = std::get_if<engine::Table>(&state.elasticity)) {
    for (const double end : {table->argument().front(), table->argument().back()})
      scale = std::max(scale, std::abs(end));
  }
  return scale;
}

}  // namespace

Interval tension_at(const engine::LinkState& state, double distance, double rest_length,
                    const Reach& reach) {
  const double elongation = distance - rest_length;
  const Interval law = tension_between(state.elasticity, distance, elongation, reach);
  const auto clamped = [&](double tension) {
    const double spring = state.stiffness * elongation + tension;
    return std::clamp(spring, state.pushes ? -state.force_limit : 0.0,
                      state.pulls ? state.force_limit : 0.0);
  };
  return {clamped(law.low), clamped(law.high)};
}

double fall_of(const engine::LinkState& state, double rest_length, const Span& span,
               const Reach& reach) {
  const Way way(state, rest_length, reach);
  const double scale =
      scale_of(std::max(std::abs(span.from), std::abs(span.to)), rest_length, state);
  constexpr double kFollowed = 10.0;  // scales
  double fall = 0.0;
  for (const double side : {1.0, -1.0}) {
    const double start = side > 0.0 ? span.from : span.to;
    const double limit = side > 0.0 ? span.highest : span.lowest;
    const double followed = side * kFollowed * scale;
    const double end = side > 0.0 ? std::min(limit, followed) : std::max(limit, followed);
    if (!(side * (end - start) > 0.0)) continue;
    double here = way.fall(start, end);
    if (std::isinf(limit)) {
      if (tail_of(way, scale, side).endless) return kEndless;
      here += std::max(way.outwards(end, side * kEndless), 0.0) * std::abs(end);  // as 1 / d^2
    }
    fall += here;
  }
  return fall;
}

double brought_by(const engine::NetworkDescription& network, const engine::StateLink& link) {
  const engine::StateMachine& state_machine = network.state_machines[link.state_machine];
  const engine::LinkState& state = state_machine.states[state_machine.start];
  const engine::LawPoint start = start_point(network, link);
  const double stored = stored_in(state_machine, start);
  if (const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity)) {
    return stored + balls->well_depth;
  }
  if (never_falls(state.elasticity)) return stored;
  Reach masses;
  masses.mass_a = {start.mass_a, start.mass_a};
  masses.mass_b = {start.mass_b, start.mass_b};
  const double lowest = network.dimension > 1 ? 0.0 : -kEndless;
  return fall_of(state, link.rest_length, {start.distance, start.distance, lowest, kEndless},
                 masses);
}

double brought_by_pair(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                       const NearestPairs& start, const Reach& reach) {
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const engine::LinkState& state = state_machine.states[state_machine.start];
  if (const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity)) {
    return balls->well_depth;
  }
  const bool has_force = state.stiffness > 0.0 || !is_none(state.elasticity);
  const bool pulls_in = state.pulls && has_force && set.range > start.rest_length;
  if (never_falls(state.elasticity) && (start.all_begin_within || !pulls_in)) return 0.0;
  double lowest = network.dimension > 1 ? 0.0 : -set.range;
  if (engine::acts_on_surfaces(network, set)) lowest = -kEndless;
  return fall_of(state, start.rest_length,
                 {std::min(start.nearest, set.range), set.range, lowest, set.range}, reach);
}

double brought_by_pairs(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                        const NearestPairs& start, const Reach& reach) {
  const double fall = brought_by_pair(network, set, start, reach);
  if (!std::isfinite(fall)) return 0.0;
  return fall * static_cast<double>(std::max(set.set_p.size(), set.set_q.size()));
}

bool drives_apart(const engine::LinkState& state, double rest_length, bool turns,
                  const Reach& reach) {
  if (std::isfinite(reach.range) || never_falls(state.elasticity)) return false;
  const Way way(state, rest_length, reach);
  const double scale = scale_of(reach.elongation, rest_length, state);
  return tail_of(way, scale, 1.0).ever_harder || (!turns && tail_of(way, scale, -1.0).ever_harder);
}

namespace {

/// Speeds at which a law of the speed is tried, either way.
std::vector<double> tried_speeds(const engine::LinkState& state, double speed) {
  constexpr int kEven = 64;
  constexpr int kHalvings = 40;
  std::vector<double> all;
  for (int i = 1; i <= kEven; ++i) all.push_back(speed * i / kEven);
  double share = 1.0;
  for (int i = 0; i < kHalvings; ++i) all.push_back(speed * (share *= 0.5));
  if (const auto* table = std::get_if<engine::Table>(&state.dissipation)) {
    for (const double corner : table->argument()) {
      if (corner != 0.0 && std::abs(corner) <= speed) all.push_back(std::abs(corner));
    }
  }
  return all;
}

/// Holds the tension over the speed of a state, less that of its elasticity at rest, against the speed: in
/// a box of distances and speeds of one sign.
class OppositionToMotion {
 public:
  /// @param box  its speed is not looked at
  OppositionToMotion(const engine::LinkState& state, const LinkBox& box)
      : state_(state), box_(box) {}

  /// True if it surely opposes all speeds up to one, either way.
  bool is_sure(double speed) const {
    int boxes_left = kMaxBoxes;
    return is_sure(speed, 1.0, boxes_left) && is_sure(speed, -1.0, boxes_left);
  }

 private:
  static constexpr int kMaxBoxes = 4000;
  static constexpr double kSlowest = 1e-9;  // of the speed

  struct Part {
    Interval distance;
    Interval speed;  // either way: above 0
  };

  bool is_sure(double speed, double sign, int& boxes_left) const {
    const double width = box_.distance.high - box_.distance.low;
    std::vector<Part> parts{{box_.distance, {kSlowest * speed, speed}}};
    while (!parts.empty()) {
      if (--boxes_left < 0) return false;
      const Part part = parts.back();
      parts.pop_back();
      if (opposes(part, sign)) continue;
      Part lower = part;
      Part upper = part;
      const Interval& d = part.distance;
      const Interval& v = part.speed;
      if ((d.high - d.low) * v.high > (v.high - v.low) * width) {
        lower.distance.high = upper.distance.low = 0.5 * (d.low + d.high);
      } else {
        lower.speed.high = upper.speed.low = std::sqrt(v.low * v.high);
      }
      parts.push_back(lower);
      parts.push_back(upper);
    }
    return true;
  }

  bool opposes(const Part& part, double sign) const {
    double least = state_.viscosity * part.speed.low;
    double size = state_.viscosity * part.speed.high;
    const auto add = [&](double low, double largest) {
      least += low;
      size += largest;
    };
    if (const auto* viscous = std::get_if<engine::Expression>(&state_.dissipation)) {
      const Interval value = values_of(viscous->program, box_of(part, sign));
      const Interval at_rest = values_of(viscous->program, box_at_rest(part));
      const Interval slope = slope_from_rest(viscous->program, part, sign);
      const double rest = sign > 0.0 ? at_rest.low : -at_rest.high;
      const double by_slope =
          rest + slope.low * (slope.low >= 0.0 ? part.speed.low : part.speed.high);
      add(larger_of(sign > 0.0 ? value.low : -value.high, by_slope), size_of(value));
    } else if (!is_none(state_.dissipation)) {
      const double low = min_viscous(part, sign);
      add(low, std::abs(low));
    }
    const auto* elastic = std::get_if<engine::Expression>(&state_.elasticity);
    if (elastic != nullptr && !elastic->is_potential()) {
      const LinkBox moving = box_of(part, sign);
      const Interval value = values_of(elastic->program, moving);
      const Interval slope = slope_from_rest(elastic->program, part, sign);
      const double by_slope = slope.low * (slope.low >= 0.0 ? part.speed.low : part.speed.high);
      add(larger_of(by_slope, above_rest(elastic->program, part, sign)), size_of(value));
    }
    return least >= -kNothing * size;
  }

  LinkBox box_of(const Part& part, double sign) const {
    LinkBox box = box_;
    box.distance = part.distance;
    box.speed = sign > 0.0 ? part.speed : Interval{-part.speed.high, -part.speed.low};
    return box;
  }
  LinkBox box_at_rest(const Part& part) const { return box_of({part.distance, {}}, 1.0); }

  /// The mean slope from rest to any speed of the part lies within; over the distances too.
  Interval slope_from_rest(const engine::Program& program, const Part& part, double sign) const {
    return enclosure_of(program, box_of({part.distance, {0.0, part.speed.high}}, sign)).over_speed;
  }

  /// The least by which it is above rest, from the middle of the distances on.
  double above_rest(const engine::Program& program, const Part& part, double sign) const {
    const double middle = 0.5 * (part.distance.low + part.distance.high);
    const double away = 0.5 * (part.distance.high - part.distance.low);
    const Part there{{middle, middle}, part.speed};
    const Interval moving = values_of(program, box_of(there, sign));
    const Interval resting = values_of(program, box_at_rest(there));
    const double above = sign > 0.0 ? moving.low - resting.high : resting.low - moving.high;
    const Interval fast = enclosure_of(program, box_of(part, sign)).over_distance;
    const Interval slow = enclosure_of(program, box_at_rest(part)).over_distance;
    return above - away * std::max(std::abs(fast.high - slow.low), std::abs(slow.high - fast.low));
  }

  /// The least that a table or a power opposes the speed; it is at an end or at a corner.
  double min_viscous(const Part& part, double sign) const {
    const auto tension = [&](double speed) {
      engine::LawPoint point;
      point.speed = sign * speed;
      return sign * viscous_tension(state_.dissipation, point);
    };
    double least = std::min(tension(part.speed.low), tension(part.speed.high));
    if (const auto* table = std::get_if<engine::Table>(&state_.dissipation)) {
      for (const double corner : table->argument()) {
        const double speed = sign * corner;
        if (speed > part.speed.low && speed < part.speed.high)
          least = std::min(least, tension(speed));
      }
    }
    return least;
  }

  /// The larger of two lower bounds, one of which may be no number.
  static double larger_of(double a, double b) { return std::isnan(a) || b > a ? b : a; }
  static double size_of(const Interval& value) {
    const double size = std::max(std::abs(value.low), std::abs(value.high));
    return std::isfinite(size) ? size : 0.0;
  }

  const engine::LinkState& state_;
  const LinkBox& box_;
};

}  // namespace

bool drives_motion(const engine::LinkState& state, const Interval& distance, double rest_length,
                   double speed, const Reach& reach) {
  const auto* elastic = std::get_if<engine::Expression>(&state.elasticity);
  const bool asks = elastic != nullptr && !elastic->is_potential();
  const auto* power = std::get_if<engine::Power>(&state.dissipation);
  const bool never = is_none(state.dissipation) || (power != nullptr && power->coefficient >= 0.0);
  if (never && !asks) return false;
  const bool is_table = std::holds_alternative<engine::Table>(state.dissipation) ||
                        std::holds_alternative<engine::Power>(state.dissipation);
  const int places = asks || !is_table ? 17 : 1;
  const std::vector<double> speeds = tried_speeds(state, speed);
  for (int i = 0; i < places; ++i) {
    const double share = places > 1 ? i / (places - 1.0) : 0.0;
    const double apart = distance.low + (distance.high - distance.low) * share;
    for (const double mass_a : {reach.mass_a.low, reach.mass_a.high}) {
      for (const double mass_b : {reach.mass_b.low, reach.mass_b.high}) {
        engine::LawPoint point{apart, apart - rest_length, 0.0, mass_a, mass_b};
        const double at_rest = elastic_tension(state.elasticity, point);
        for (const double each : speeds) {
          for (const double v : {each, -each}) {
            point.speed = v;
            const double spring = asks ? elastic_tension(state.elasticity, point) - at_rest : 0.0;
            const double tension =
                state.viscosity * v + viscous_tension(state.dissipation, point) + spring;
            const double size = state.viscosity * each + std::abs(tension) + std::abs(at_rest);
            if (tension * v < -kNothing * size * each) return true;
          }
        }
      }
    }
  }
  if (is_table && !asks) return false;
  LinkBox box{distance, {}, rest_length, reach.mass_a, reach.mass_b};
  box.variables = reach.variables.get();
  return !OppositionToMotion(state, box).is_sure(speed);
}

}  // namespace cordis::plan
