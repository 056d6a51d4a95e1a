// sim_node/engine/integrators/stiff_friction.cpp
#include "sim_node/engine/integrators/stiff_friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim_node/engine/integrators/implicit_damping.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/world_state.h"

namespace cordis::engine {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kMaxSpeed = 1.0;  // at which a law without a steepest place is looked at [m/s]

double inverse_mass(const Mat& mat) noexcept {
  return mat.kind == MatKind::kMass ? 1.0 / mat.mass : 0.0;
}

/// Slope of a dissipation over the speed where it is steepest [N s/m].
double steepest(const Law& law) noexcept {
  if (asks_for_variable(law)) return kUnbounded;  // what it will be is not known
  LawRange range{kMaxSpeed};
  range.viscous = true;
  range.rest_length = 1.0;
  range.mass = 1.0;
  range.samples = 64;
  const LawSlope slope = largest_slope(law, range);
  return slope.infinite_at_zero ? kUnbounded : slope.value;
}

/// @param slope, viscosity, steps  room for one value of each state machine, MAT and state link
void find_steps(const NetworkDescription& network, const std::vector<StateMachine>& state_machines,
                std::vector<double>& slope, std::vector<double>& viscosity,
                std::vector<double>& steps) noexcept {
  for (std::size_t i = 0; i < state_machines.size(); ++i) {
    slope[i] = 0.0;
    for (const LinkState& state : state_machines[i].states) {
      slope[i] = std::max(slope[i], state.viscosity + steepest(state.dissipation));
    }
  }
  std::fill(viscosity.begin(), viscosity.end(), 0.0);
  for (const StateLink& link : network.state_links) {
    if (std::isinf(slope[link.state_machine])) continue;  // never extrapolated
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      viscosity[mat] += slope[link.state_machine] * inverse_mass(network.mats[mat]);
    }
  }
  for (std::size_t l = 0; l < steps.size(); ++l) {
    const StateLink& link = network.state_links[l];
    const double of_ends = viscosity[link.mat_a] + viscosity[link.mat_b];
    steps[l] = slope[link.state_machine] > 0.0 ? kMaxExtrapolatedViscosity / of_ends : kUnbounded;
    if (std::isinf(slope[link.state_machine])) steps[l] = 0.0;
  }
}

/// The tension of one link at 8 speeds, everything else being as it is.
class TensionOverSpeed {
 public:
  static constexpr std::size_t kCount = kStateBatch;

  TensionOverSpeed(const WorldState& world, std::uint32_t link) noexcept
      : find_tensions_(world.state_machines.tensions),
        state_(world.table.terms()[world.state_links.state_index(link)]),
        dt_(world.network->step()) {
    const NetworkDescription& network = world.description();
    const StateLink& ends = network.state_links[link];
    const Vec3 along = world.mats.position(ends.mat_b) - world.mats.position(ends.mat_a);
    fill(distance_, network.dimension == 1 ? along.x() : along.norm());
    fill(one_, 1.0);
    fill(rest_length_, world.state_links.rest_length(link));
    fill(mass_a_,
         network.mats[ends.mat_a].kind == MatKind::kMass ? network.mats[ends.mat_a].mass : 0.0);
    fill(mass_b_,
         network.mats[ends.mat_b].kind == MatKind::kMass ? network.mats[ends.mat_b].mass : 0.0);
  }

  void find(const std::array<double, kCount>& speeds) noexcept {
    for (std::size_t i = 0; i < kCount; ++i) increments_[i] = speeds[i] * dt_;
    find_tensions_(state_, {kCount, distance_, one_, increments_, rest_length_, mass_a_, mass_b_,
                            1.0 / dt_, tension_, viscous_});
  }
  double tension(std::size_t i) const noexcept { return tension_[i]; }
  double viscous(std::size_t i) const noexcept { return viscous_[i]; }

 private:
  static void fill(double* values, double value) noexcept { std::fill_n(values, kCount, value); }

  FindTensions find_tensions_;
  const StateTerm& state_;
  double dt_;
  alignas(64) double distance_[kCount];
  alignas(64) double one_[kCount];
  alignas(64) double increments_[kCount];
  alignas(64) double rest_length_[kCount];
  alignas(64) double mass_a_[kCount];
  alignas(64) double mass_b_[kCount];
  alignas(64) double tension_[kCount];
  alignas(64) double viscous_[kCount];
};

/// An interval in which u - u_free + half_mobility * tension(u) goes through 0.
struct Bracket {
  double low;  // speeds; `low` need not be the smaller one
  double high;
  double at_low;  // values there, of different signs
  double at_high;

  /// Moves the end on whose side of 0 the value is, when the speed is between the ends.
  void narrow(double speed, double value) noexcept {
    if (!((speed - low) * (high - speed) > 0.0)) return;
    if ((value < 0.0) == (at_low < 0.0)) {
      low = speed;
      at_low = value;
    } else {
      high = speed;
      at_high = value;
    }
  }
  double secant() const noexcept {
    const double speed = low - at_low * ((high - low) / (at_high - at_low));
    return (speed - low) * (high - speed) >= 0.0 ? speed : 0.5 * (low + high);
  }
};

/// Looks from `begin`, where the value is `at_begin`, towards the root: as far as a law that never
/// falls can have it, in ever longer strides, then farther.
bool find_bracket(TensionOverSpeed& curve, double begin, double at_begin, double half_mobility,
                  double free_speed, Bracket& bracket) noexcept {
  constexpr int kIterations = 4;
  constexpr double kStride = 4.0;
  bracket = {begin, begin, at_begin, at_begin};
  double far = -at_begin;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::array<double, TensionOverSpeed::kCount> speeds{};
    double reach = far;
    for (std::size_t i = speeds.size(); i-- > 0; reach /= kStride) speeds[i] = begin + reach;
    curve.find(speeds);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const double value = speeds[i] - free_speed + half_mobility * curve.tension(i);
      if ((value < 0.0) != (at_begin < 0.0) || value == 0.0) {
        bracket.high = speeds[i];
        bracket.at_high = value;
        return std::isfinite(value);
      }
      bracket.low = speeds[i];
      bracket.at_low = value;
    }
    for (int i = 0; i < 8; ++i) far *= kStride;
  }
  return false;
}

/// Narrows it down to rounding; a jump of the law as well as a smooth place.
double find_root(TensionOverSpeed& curve, double half_mobility, double free_speed,
                 Bracket bracket) noexcept {
  constexpr int kMaxIterations = 40;  // each takes three quarters away, where it finds no better
  constexpr double kNear = 1.0 / (1 << 13);
  constexpr double kNearest = kNear * kNear;
  const double rounding = 1e-15 * (std::abs(free_speed) + std::abs(bracket.high));
  for (int iteration = 0; iteration < kMaxIterations && bracket.at_high != 0.0; ++iteration) {
    const double width = bracket.high - bracket.low;
    if (!(std::abs(width) > rounding)) break;
    const double guess = bracket.secant();
    const std::array<double, TensionOverSpeed::kCount> speeds{guess,
                                                              guess - kNearest * width,
                                                              guess + kNearest * width,
                                                              guess - kNear * width,
                                                              guess + kNear * width,
                                                              bracket.low + 0.25 * width,
                                                              bracket.low + 0.5 * width,
                                                              bracket.low + 0.75 * width};
    curve.find(speeds);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const double value = speeds[i] - free_speed + half_mobility * curve.tension(i);
      if (value == 0.0) return speeds[i];
      bracket.narrow(speeds[i], value);
    }
  }
  return bracket.at_high == 0.0 ? bracket.high : bracket.secant();
}

/// The root of u - free_speed + half_mobility * tension(u) on the side and branch of a speed.
std::optional<double> root_near(TensionOverSpeed& curve, double speed, double half_mobility,
                                double free_speed) noexcept {
  curve.find({speed});
  const double value = speed - free_speed + half_mobility * curve.tension(0);
  if (value == 0.0) return speed;
  Bracket bracket{};
  if (!find_bracket(curve, speed, value, half_mobility, free_speed, bracket)) return {};
  return find_root(curve, half_mobility, free_speed, bracket);
}

/// The slope at a speed of what dissipates [N s/m], over a small part of a scale of speeds.
double slope_at(TensionOverSpeed& curve, double speed, double scale) noexcept {
  constexpr double kSmall = 1e-7;
  const double apart = kSmall * scale;
  if (!(apart > 0.0)) return 0.0;
  curve.find({speed - apart, speed + apart});
  return (curve.viscous(1) - curve.viscous(0)) / (2.0 * apart);
}

}  // namespace

std::vector<double> largest_extrapolated_steps(const NetworkDescription& network) {
  std::vector<double> slope(network.state_machines.size());
  std::vector<double> viscosity(network.mats.size());
  std::vector<double> steps(network.state_links.size());
  find_steps(network, network.state_machines, slope, viscosity, steps);
  return steps;
}

std::optional<std::uint32_t> heaviest_solved_friction(const NetworkDescription& network) {
  if (network.integrator != IntegratorKind::kLeapfrog) return {};
  std::vector<double> slope(network.state_machines.size());
  std::vector<double> viscosity(network.mats.size());
  std::vector<double> steps(network.state_links.size());
  find_steps(network, network.state_machines, slope, viscosity, steps);
  std::optional<std::uint32_t> heaviest;
  double most = 0.0;  // [1/s]
  for (std::uint32_t l = 0; l < steps.size(); ++l) {
    const StateLink& link = network.state_links[l];
    const double mobility =
        inverse_mass(network.mats[link.mat_a]) + inverse_mass(network.mats[link.mat_b]);
    if (network.step <= steps[l] || mobility == 0.0) continue;
    const double own = slope[link.state_machine] * mobility;
    if (heaviest && own <= most) continue;
    heaviest = l;
    most = own;
  }
  return heaviest;
}

bool solves_stiff_friction(const NetworkDescription& network) {
  return heaviest_solved_friction(network).has_value();
}

StiffFriction::StiffFriction(const NetworkDescription& network)
    : dt_(network.step),
      is_1d_(network.dimension == 1),
      steps_(network.state_links.size()),
      viscosity_(network.mats.size()),
      slope_(network.state_machines.size()),
      met_(network.mats.size()) {
  solved_.reserve(network.state_links.size());
  choose(network, network.state_machines);
}

void StiffFriction::choose(const NetworkDescription& network,
                           const std::vector<StateMachine>& state_machines) noexcept {
  find_steps(network, state_machines, slope_, viscosity_, steps_);
  solved_.clear();
  std::fill(met_.begin(), met_.end(), std::uint8_t{0});
  share_masses_ = false;
  for (std::uint32_t l = 0; l < steps_.size(); ++l) {
    const StateLink& link = network.state_links[l];
    const double mobility =
        inverse_mass(network.mats[link.mat_a]) + inverse_mass(network.mats[link.mat_b]);
    if (dt_ <= steps_[l] || mobility == 0.0) continue;
    Solved solved;  // there is room for all
    solved.link = l;
    solved.half_mobility = solved.undamped_mobility = 0.5 * dt_ * mobility;
    solved_.push_back(solved);
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      if (network.mats[mat].kind != MatKind::kMass) continue;
      share_masses_ = share_masses_ || met_[mat] != 0;
      met_[mat] = 1;
    }
  }
}

void StiffFriction::add_tension(WorldState& world, const Solved& solved, double tension) noexcept {
  const StateLink& ends = world.description().state_links[solved.link];
  const Vec3 force = tension * solved.axis;
  world.mats.set_force(ends.mat_a, world.mats.force(ends.mat_a) + force);
  world.mats.set_force(ends.mat_b, world.mats.force(ends.mat_b) - force);
}

void StiffFriction::begin_step(const WorldState& world) noexcept {
  for (Solved& solved : solved_) solved.tension = world.state_links.tension(solved.link);
}

/// Takes the tension of the last step in place of the one with the extrapolated speed, which may be
/// far too large.
void StiffFriction::prepare(WorldState& world, const Around& around, Solved& solved) noexcept {
  const StateLink& ends = world.description().state_links[solved.link];
  Vec3 along = world.mats.position(ends.mat_b) - world.mats.position(ends.mat_a);
  const double length =
      std::sqrt(along.x() * along.x() + along.y() * along.y() + along.z() * along.z());
  solved.rests =
      world.state_links.is_new(solved.link, world.step_count) || (!is_1d_ && length == 0.0);
  if (solved.rests) return;
  solved.axis = is_1d_ ? Vec3(Vec3::UnitX()) : Vec3(along / length);
  const auto extrapolated = [&](std::uint32_t mat) {
    return Vec3(world.mats.position(mat) -
                world.mats.layout().vector(around.extrapolated.data(), mat));
  };
  solved.length = length;
  solved.speed = solved.axis.dot(extrapolated(ends.mat_b) - extrapolated(ends.mat_a)) / dt_;
  solved.extrapolated_speed = solved.speed;
  solved.speed_of_law = solved.speed;
  TensionOverSpeed curve(world, solved.link);
  curve.find({solved.speed});
  solved.elastic = curve.tension(0) - curve.viscous(0);
  solved.viscous_power = curve.viscous(0) * solved.speed;
  const double explicit_tension = world.state_links.tension(solved.link);
  if (!around.started) solved.tension = explicit_tension;
  add_tension(world, solved, solved.tension - explicit_tension);
}

/// The centred speed that all forces but its own tension leave a link. In the first step, which begins
/// with a velocity that its explicit forces have made, that of the middle of the step.
double StiffFriction::free_speed(const WorldState& world, const Around& around,
                                 const Solved& solved) const noexcept {
  const StateLink& ends = world.description().state_links[solved.link];
  if (around.damping != nullptr) {
    const double speed = around.damping->elongation(ends.mat_a, ends.mat_b, solved.axis) / dt_;
    return speed + solved.half_mobility * solved.tension;
  }
  const double part = around.started ? 0.5 : 1.0;
  const auto moved = [&](std::uint32_t mat) {
    // Of a driven port the extrapolated place counts, as its velocity at x(n).
    if (!world.mats.is_mass(mat)) {
      return Vec3(world.mats.position(mat) -
                  world.mats.layout().vector(around.extrapolated.data(), mat));
    }
    Vec3 moving = world.mats.position(mat) - world.mats.delayed(mat);
    Vec3 force = world.mats.force(mat) + world.port_inputs.external_force(mat);
    force += world.mats.force_of_medium(
        mat, world.mats.layout().vector(around.extrapolated.data(), mat));
    moving += part * world.mats.kick_of(mat, force);
    return moving;
  };
  const double speed = solved.axis.dot(moved(ends.mat_b) - moved(ends.mat_a)) / dt_;
  return speed + solved.half_mobility * solved.tension;
}

/// The speed of a link in the half step before [m/s].
double StiffFriction::speed_before(const WorldState& world, const Around& around,
                                   const Solved& solved) const noexcept {
  const StateLink& ends = world.description().state_links[solved.link];
  if (around.damping != nullptr)
    return around.damping->elongation_before(ends.mat_a, ends.mat_b, solved.axis) / dt_;
  const auto moved = [&](std::uint32_t mat) {
    return Vec3(world.mats.position(mat) - world.mats.delayed(mat));
  };
  return solved.axis.dot(moved(ends.mat_b) - moved(ends.mat_a)) / dt_;
}

/// Finds the speeds of a link. The first round of a step finds how far ahead the law is taken.
/// @return its tension; that it has when no root is found
double StiffFriction::solve_one(const WorldState& world, const Around& around, Solved& solved,
                                bool first_round) noexcept {
  constexpr double kFree = 0.9;  // of the mobility without implicit dampers
  const double free = free_speed(world, around, solved);
  const double before = speed_before(world, around, solved);
  TensionOverSpeed curve(world, solved.link);
  double tension = solved.tension;
  // u + ahead (u - before) = s
  const auto solve_ahead = [&](double ahead) {
    const double later_free = free + ahead * (free - before);
    const double mobility = (1.0 + ahead) * solved.half_mobility;
    const std::optional<double> root = root_near(curve, solved.speed_of_law, mobility, later_free);
    if (!root) return;
    solved.ahead = ahead;
    solved.speed_of_law = *root;
    tension = (later_free - *root) / mobility;
  };
  solve_ahead(first_round ? 0.0 : solved.ahead);
  const bool may_ring = around.started && solved.half_mobility > kFree * solved.undamped_mobility;
  if (first_round && may_ring) {
    const double scale = std::abs(free) + std::abs(before) + std::abs(solved.speed_of_law);
    const double steepness = solved.half_mobility * slope_at(curve, solved.speed_of_law, scale);
    if (steepness > 1.0) solve_ahead(1.0 - 1.0 / steepness);
  }
  if (std::isfinite(tension)) solved.speed = free - solved.half_mobility * tension;
  return tension;
}

/// Counts the tensions as constant over the period, and finds the velocities with them.
void StiffFriction::find_damped_velocities(WorldState& world, ImplicitDamping& damping) noexcept {
  add_to(damping, world, 1.0);
  damping.find_velocities(world.mats, &world.port_inputs);
  add_to(damping, world, -1.0);
}

/// Adds a part of the present tensions to the forces that are constant over the period.
void StiffFriction::add_to(ImplicitDamping& damping, const WorldState& world,
                           double part) const noexcept {
  for (const Solved& solved : solved_) {
    if (solved.rests) continue;
    const StateLink& ends = world.description().state_links[solved.link];
    damping.add_constant_force(ends.mat_a, part * solved.tension * solved.axis);
    damping.add_constant_force(ends.mat_b, -part * solved.tension * solved.axis);
  }
}

double StiffFriction::solve(WorldState& world, const AlignedVector<double>& extrapolated,
                            ImplicitDamping* damping, bool started) noexcept {
  if (solved_.empty()) return 0.0;
  const Around around{extrapolated, damping, started};
  for (Solved& solved : solved_) prepare(world, around, solved);
  if (damping != nullptr) find_damped_velocities(world, *damping);
  constexpr double kSettled = 1e-10;  // of the largest tension
  // Dampers couple all links.
  const bool in_turn = share_masses_ || (damping != nullptr && solved_.size() > 1);
  const double part = started || damping != nullptr ? 1.0 : 0.5;
  for (int round = 0; round < (in_turn ? kMaxRounds : 1); ++round) {
    double largest = 0.0;
    double changed = 0.0;
    for (Solved& solved : solved_) {
      if (solved.rests) continue;
      if (damping != nullptr) {
        const StateLink& ends = world.description().state_links[solved.link];
        solved.half_mobility = damping->find_response(ends.mat_a, ends.mat_b, solved.axis) / dt_;
      }
      const double tension = solve_one(world, around, solved, round == 0);
      if (!std::isfinite(tension)) continue;
      add_tension(world, solved, part * (tension - solved.tension));
      if (damping != nullptr) damping->add_response(tension - solved.tension);
      largest = std::max(largest, std::abs(tension));
      changed = std::max(changed, std::abs(tension - solved.tension));
      solved.tension = tension;
    }
    if (!(changed > kSettled * largest)) break;
  }
  if (damping != nullptr) add_to(*damping, world, 1.0);
  // ImplicitDamping::advance() adds the rest of what such forces take on the way.
  const bool counts_on = damping != nullptr;
  double power = 0.0;
  for (const Solved& solved : solved_) {
    if (solved.rests) continue;
    const double viscous = solved.tension - solved.elastic;
    const double speed = counts_on ? solved.extrapolated_speed : solved.speed;
    power += viscous * speed - solved.viscous_power;
    world.state_links.set_tension(solved.link, solved.tension);
    if (counts_on) world.state_links.set_viscous_tension(solved.link, viscous, solved.length);
  }
  return 0.5 * dt_ * power;
}

}  // namespace cordis::engine
