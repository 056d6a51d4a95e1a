// sim_node/plan/stability/bend_slope.cpp
#include "sim_node/plan/stability/bend_slope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/links/bend_moment.h"
#include "sim_node/engine/links/bend_shape.h"
#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/scene_box.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

/// The angle of BendOfLaw where sides of their rest lengths are folded [rad].
constexpr double kFolded = 2.6;

constexpr const char* kJumpsWhereStraight = "its moment jumps where the bend is straight";
constexpr const char* kBendFallsWithoutEnd = "its potential falls without an end";

/// The angle of BendOfLaw over the length of the bend vector: its slope, and the slope of that.
struct Growth {
  double slope = 1.0;
  double bend = 0.0;  // of the slope

  /// A moment of the slope m over the angle is at most this times m steep over the length.
  double factor(double angle) const noexcept { return slope * slope + angle * bend; }
};

Growth growth_at(double angle, int dimension) {
  if (dimension == 1) return {};
  const double half = 0.5 * std::min(std::abs(angle), engine::kLargestExactBend);
  const double cosine = std::cos(half);
  return {1.0 / cosine, 0.5 * std::sin(half) / (cosine * cosine * cosine)};
}

double mobility_of(const engine::Mat& mat) noexcept {
  return mat.kind == engine::MatKind::kMass ? 1.0 / mat.mass : 0.0;
}

/// A state of the laws alone.
engine::LinkState laws_alone(const engine::LinkState& state) {
  const engine::LawsOfBend laws = laws_of_bend(state);
  engine::LinkState alone;
  if (laws.elasticity != nullptr) alone.elasticity = *laws.elasticity;
  if (laws.dissipation != nullptr) alone.dissipation = *laws.dissipation;
  return alone;
}

/// How far a force may be from a bend along the line of the scene [m]: the diagonal of the box about all MATs; in 1 dimension,
/// where that is across, all sides of bends together.
double lever_of(const NetworkDescription& network) {
  double sides = 0.0;
  for (const engine::Bend& bend : network.bends) sides += bend.length_ab + bend.length_bc;
  if (network.dimension == 1) return sides;
  return diagonal_of(network);
}

double angle_at_start(const NetworkDescription& network, const engine::Bend& bend) {
  return engine::bend_of_law(bend_at_start(network, bend), engine::Vec3::Zero(), network.dimension)
      .angle;
}

bool has_several_states(const NetworkDescription& network, const engine::Bend& bend) {
  return !network.state_machines[bend.state_machine].is_stateless();
}

}  // namespace

SlopesOfBends::SlopesOfBends(const NetworkDescription& network, const Reach& reach)
    : network_(network), reach_(reach), lever_(network.bends.empty() ? 0.0 : lever_of(network)) {}

/// Elongations are angles here, and speeds their rates. Masses stand so that two MATs that meet have the energy that they
/// have: in laws of bends no mass is asked for.
Reach SlopesOfBends::reach_at(const engine::Bend& bend) const {
  const double steepest = growth_at(kFolded, network_.dimension).slope;
  const double per_ab = 1.0 / bend.length_ab;
  const double per_bc = 1.0 / bend.length_bc;
  const double rate = steepest * (per_ab + per_bc);
  Reach reach = reach_between(reach_, network_, {bend.mat_a, bend.mat_b, bend.mat_c},
                              {bend.mat_a, bend.mat_b, bend.mat_c});
  for (Interval* mass : {&reach.mass_a, &reach.mass_b}) {
    mass->low /= rate * rate;
    mass->high /= rate * rate;
  }
  const auto mobility = [&](std::uint32_t mat, double per_length) {
    return mobility_of(network_.mats[mat]) * per_length * per_length;
  };
  reach.inverse_mass = steepest * steepest *
                       (mobility(bend.mat_a, per_ab) + mobility(bend.mat_b, per_ab + per_bc) +
                        mobility(bend.mat_c, per_bc));
  reach.speed *= rate;
  reach.force *= lever_;
  reach.driven *= lever_;
  const double start = angle_at_start(network_, bend);
  const double farthest = std::max(std::abs(start), network_.dimension == 1 ? 0.1 : kFolded);
  reach.elongation = network_.dimension == 1 ? 2.0 * farthest : farthest;
  reach.begins = {std::min(start, -start), std::max(start, -start)};
  reach.range = std::numeric_limits<double>::infinity();
  // A change of state may begin it anywhere, and nothing bounds the energy of a parameter that changes.
  reach.held = reach.held || has_several_states(network_, bend) ||
               laws_ask_for_variable(network_.state_machines[bend.state_machine]);
  return reach;
}

Slope SlopesOfBends::slope_of(const engine::LinkState& state, const engine::Bend& bend,
                              const Reach& reach) const {
  const int dimension = network_.dimension;
  engine::StateMachine machine;
  machine.states.push_back(laws_alone(state));
  const engine::LinkState& laws = machine.states.front();
  Slope slope = largest_slope(machine, 0.0, 1, reach);
  if (dimension == 1) {
    const double start = angle_at_start(network_, bend);
    constexpr double kAnywhere = std::numeric_limits<double>::infinity();
    const bool falls =
        !std::isfinite(fall_of(laws, 0.0, {start, start, -kAnywhere, kAnywhere}, reach));
    if (slope.uncertainty == nullptr && falls) slope.uncertainty = kBendFallsWithoutEnd;
    if (slope.uncertainty == nullptr && !slope.bounded && has_several_states(network_, bend))
      slope.uncertainty = "a change of state may begin it where it is steep";
    return slope;
  }
  const Interval straight = tension_between(laws.elasticity, 0.0, 0.0, reach);
  constexpr double kNothing = 1e-9;
  const double size = slope.stiffness + slope.variation;
  if (slope.uncertainty == nullptr && std::max(straight.high, -straight.low) > kNothing * size)
    slope.uncertainty = kJumpsWhereStraight;
  const Stretch stretch = stretch_within(laws, 0.0, false, reach);
  const double farthest = std::max(stretch.longer, stretch.shorter);
  const double reached = std::min(farthest, engine::kLargestExactBend);
  const Growth growth = growth_at(reached, dimension);
  const double factor = growth.factor(reached);
  const Interval moment = tension_between(laws.elasticity, reached, reached, reach);
  const double end = std::max({moment.high, -moment.low, 0.0}) * growth.bend;
  if (farthest < engine::kLargestExactBend) slope.bounded = false;
  const double growing = (factor - 1.0) * slope.stiffness;
  slope.variation = factor * slope.variation + growing;
  slope.fall *= factor;
  slope.fall_anywhere *= factor;
  // Where the angle goes on along its tangent, the slope of its slope ends.
  if (farthest >= engine::kLargestExactBend) slope.fall += end;
  slope.fall_anywhere += end;
  slope.stiffness *= factor;
  slope.viscosity *= growth.slope * growth.slope;
  return slope;
}

const Slope& SlopesOfBends::slope_of(const engine::Bend& bend) {
  CORDIS_ASSERT(bend.has_states());
  const Reach reach = reach_at(bend);
  const Key key{bend.state_machine,
                static_cast<float>(bend.length_ab),
                static_cast<float>(bend.length_bc),
                static_cast<float>(reach.inverse_mass),
                static_cast<float>(reach.elongation),
                reach.held};
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  Slope largest;
  for (const engine::LinkState& state : network_.state_machines[bend.state_machine].states) {
    if (!laws_of_bend(state).any()) continue;
    const Slope slope = slope_of(state, bend, reach);
    largest.stiffness = std::max(largest.stiffness, slope.stiffness);
    largest.viscosity = std::max(largest.viscosity, slope.viscosity);
    largest.variation = std::max(largest.variation, slope.variation);
    largest.fall = std::max(largest.fall, slope.fall);
    largest.fall_anywhere = std::max(largest.fall_anywhere, slope.fall_anywhere);
    largest.bounded = largest.bounded && slope.bounded;
    if (largest.uncertainty == nullptr) largest.uncertainty = slope.uncertainty;
  }
  return known_.emplace(key, largest).first->second;
}

double brought_by_laws(const NetworkDescription& network, const engine::Bend& bend) {
  const engine::StateMachine& machine = network.state_machines[bend.state_machine];
  if (!has_laws_of_bends(machine) || laws_ask_for_variable(machine)) return 0.0;
  const double start = angle_at_start(network, bend);
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  const bool is_line = network.dimension == 1;
  const double end = is_line ? kAnywhere : std::max(kFolded, std::abs(start));
  const bool anywhere = has_several_states(network, bend);
  const double away = anywhere ? std::max(kFolded, std::abs(start)) : std::abs(start);
  double most = 0.0;
  for (const engine::LinkState& state : machine.states) {
    const engine::LinkState laws = laws_alone(state);
    if (is_none(laws.elasticity)) continue;
    const double fall =
        fall_of(laws, 0.0, {anywhere ? -away : start, anywhere ? away : start, -end, end}, {});
    if (std::isfinite(fall)) most = std::max(most, fall);
    for (const double angle : {away, -away}) {
      const double stored = potential(laws.elasticity, {angle, angle});
      if (std::isfinite(stored)) most = std::max(most, stored);
    }
  }
  return most;
}

BendTangent tangent_of_laws(const NetworkDescription& network, const engine::Bend& bend) {
  const engine::StateMachine& machine = network.state_machines[bend.state_machine];
  const engine::LinkState& state = machine.states[machine.start];
  BendTangent found;
  if (!laws_of_bend(state).any()) return found;
  engine::StateMachine alone;
  alone.states.push_back(laws_alone(state));
  const engine::Vec3 w = bend_at_start(network, bend);
  const engine::BendOfLaw seen = engine::bend_of_law(w, engine::Vec3::Zero(), network.dimension);
  const Tangent tangent = tangent_at_start(alone, {seen.angle, seen.angle});
  found.is_sure = !tangent.jumps && !tangent.sticks;
  if (network.dimension == 1)
    return {tangent.stiffness, tangent.stiffness, tangent.viscosity, found.is_sure};
  const double length = w.norm();
  const Growth growth = growth_at(seen.angle, network.dimension);
  const double bend_of_slope = seen.angle < engine::kLargestExactBend ? growth.bend : 0.0;
  found.along = tangent.stiffness * seen.slope * seen.slope + tangent.tension * bend_of_slope;
  constexpr double kStraight = 1e-9;
  found.across = length > kStraight ? tangent.tension * seen.slope / length : found.along;
  found.viscosity = tangent.viscosity * seen.slope * seen.slope;
  return found;
}

}  // namespace cordis::plan
