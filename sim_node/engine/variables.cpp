// sim_node/engine/variables.cpp
#include "sim_node/engine/variables.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "node/assert.h"
#include "sim_node/engine/core/float_mode.h"
#include "sim_node/engine/links/bend_angle.h"

namespace cordis::engine {

namespace {

/// Distance of the ends of a link and its elongation rate, by the law of Link.
struct Stretch {
  double distance = 0.0;
  double elongation_rate = 0.0;
};

Stretch stretch_of(std::uint32_t a, std::uint32_t b, const World& world) noexcept {
  const Vec3 along = world.position(b) - world.position(a);
  const Vec3 moved = world.velocity(b) - world.velocity(a);
  if (world.network().dimension() == 1) return {along.x(), moved.x()};
  const double distance = along.norm();
  return {distance, distance > 0.0 ? along.dot(moved) / distance : 0.0};
}

double value_of_state_link(const Variable& variable, const World& world) noexcept {
  const StateLink& link = world.network().description().state_links[variable.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  switch (variable.quantity) {
    case VariableKind::kDistance:
      return stretch.distance;
    case VariableKind::kElongation:
      return stretch.distance - world.rest_length_of(variable.index);
    case VariableKind::kElongationRate:
      return stretch.elongation_rate;
    case VariableKind::kState:
      return world.state_of(variable.index);
    case VariableKind::kRestLength:
      return world.rest_length_of(variable.index);
    case VariableKind::kAge:
      return world.age_of(variable.index);
    default:
      return world.tension_of(variable.index);
  }
}

double value_of_maxwell_link(const Variable& variable, const World& world) noexcept {
  if (variable.quantity == VariableKind::kTension) return world.tension_of_maxwell(variable.index);
  const MaxwellLink& link = world.network().description().maxwell_links[variable.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  return variable.quantity == VariableKind::kDistance ? stretch.distance : stretch.elongation_rate;
}

double value_of_bend(const Variable& variable, const World& world) noexcept {
  if (variable.quantity == VariableKind::kState) return world.state_of_bend(variable.index);
  if (variable.quantity == VariableKind::kAge) return world.age_of_bend(variable.index);
  const NetworkDescription& network = world.network().description();
  Bend bend = network.bends[variable.index];
  if (bend.has_states()) {
    if (variable.quantity == VariableKind::kMoment) return world.moment_of_bend(variable.index);
    bend.rest_angle = world.rest_angle_of_bend(variable.index);
  }
  if (variable.quantity == VariableKind::kRestAngle) return bend.rest_angle;
  const auto side = [&world](std::uint32_t a, std::uint32_t b) -> Vec3 {
    return world.position(b) - world.position(a);
  };
  const auto rate = [&world](std::uint32_t a, std::uint32_t b) -> Vec3 {
    return world.velocity(b) - world.velocity(a);
  };
  const BendSides sides{side(bend.mat_a, bend.mat_b), side(bend.mat_b, bend.mat_c),
                        rate(bend.mat_a, bend.mat_b), rate(bend.mat_b, bend.mat_c)};
  if (variable.quantity == VariableKind::kMoment)
    return moment_about_middle(bend, network.dimension, sides,
                               moment_of(bend, network.dimension, sides));
  const AngleAndRate now = angle_of(bend, network.dimension, sides);
  if (variable.quantity == VariableKind::kAngle) return now.angle;
  if (variable.quantity == VariableKind::kAngularSpeed) return now.rate;
  return angle_beyond(bend.rest_angle, now.angle, network.dimension);
}

/// Calls (mass, MAT) for each mass of a group.
template <class Visit>
void visit_masses(const VariableGroup& group, const World& world, Visit visit) noexcept {
  const std::vector<Mat>& mats = world.network().description().mats;
  for (const std::uint32_t mat : group.members) {
    if (mats[mat].kind == MatKind::kMass) visit(mats[mat].mass, mat);
  }
}

/// The masses of a group times a vector of each, and without it.
struct MassSum {
  double mass = 0.0;  // [kg]
  Vec3 sum = Vec3::Zero();
};

template <class VectorOf>
MassSum sum_over(const VariableGroup& group, const World& world, VectorOf vector_of) noexcept {
  MassSum sums;
  visit_masses(group, world, [&](double mass, std::uint32_t mat) {
    sums.mass += mass;
    sums.sum += mass * vector_of(mat);
  });
  return sums;
}

MassSum sum_of_positions(const VariableGroup& group, const World& world) noexcept {
  return sum_over(group, world, [&](std::uint32_t mat) { return world.position(mat); });
}

MassSum momentum_of(const VariableGroup& group, const World& world) noexcept {
  return sum_over(group, world, [&](std::uint32_t mat) { return world.velocity(mat); });
}

/// Sum of m (x - p) x (v - V), with V the velocity of the centre of mass where it is p, else 0.
Vec3 angular_momentum_of(const Variable& variable, const World& world) noexcept {
  const VariableGroup& group = world.network().description().groups[variable.index];
  Vec3 point = variable.point;
  Vec3 velocity = Vec3::Zero();
  if (!variable.is_about_point) {
    const MassSum positions = sum_of_positions(group, world);
    point = positions.sum / positions.mass;
    velocity = momentum_of(group, world).sum / positions.mass;
  }
  Vec3 sum = Vec3::Zero();
  visit_masses(group, world, [&](double mass, std::uint32_t mat) {
    sum += mass * (world.position(mat) - point).cross(world.velocity(mat) - velocity);
  });
  return sum;
}

double value_of_body(const Variable& variable, const World& world) noexcept {
  const FloatMode mode;
  if (variable.quantity == VariableKind::kAngularMomentum) {
    return variable.direction.dot(angular_momentum_of(variable, world));
  }
  const VariableGroup& group = world.network().description().groups[variable.index];
  if (variable.quantity == VariableKind::kMomentum) {
    return variable.direction.dot(momentum_of(group, world).sum);
  }
  const MassSum positions = sum_of_positions(group, world);
  return variable.direction.dot(positions.sum / positions.mass) - variable.offset;
}

/// Takes the values of the members of a group together.
double value_of_many(const Variable& variable, const World& world, const Energy& energy) noexcept {
  const FloatMode mode;
  const std::vector<std::uint32_t>& members =
      world.network().description().groups[variable.index].members;
  Variable one = variable;
  one.take = Take::kOne;
  one.index = members.front();
  double value = value_of(one, world, energy);
  for (std::size_t i = 1; i < members.size(); ++i) {
    one.index = members[i];
    const double next = value_of(one, world, energy);
    if (variable.take == Take::kLargest) {
      value = std::max(value, next);
    } else if (variable.take == Take::kSmallest) {
      value = std::min(value, next);
    } else {
      value += next;
    }
  }
  return variable.take == Take::kMean ? value / static_cast<double>(members.size()) : value;
}

double value_of_link(const Variable& variable, const World& world) noexcept {
  if (variable.kind == LinkKind::kBend) return value_of_bend(variable, world);
  if (variable.kind == LinkKind::kState) return value_of_state_link(variable, world);
  if (variable.kind == LinkKind::kMaxwell) return value_of_maxwell_link(variable, world);
  const Link& link = world.network().description().links[variable.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  const double elongation = stretch.distance - link.rest_length;
  switch (variable.quantity) {
    case VariableKind::kDistance:
      return stretch.distance;
    case VariableKind::kElongation:
      return elongation;
    case VariableKind::kElongationRate:
      return stretch.elongation_rate;
    default:
      break;
  }
  const bool without_direction = world.network().dimension() > 1 && stretch.distance == 0.0;
  return without_direction ? 0.0
                           : link.stiffness * elongation + link.viscosity * stretch.elongation_rate;
}

double awake_in(const World& world) noexcept {
  return 1.0 - world.asleep_count() / static_cast<double>(world.network().mass_count());
}

double energy_of(VariableKind kind, const Energy& energy) noexcept {
  switch (kind) {
    case VariableKind::kKineticEnergy:
      return energy.kinetic;
    case VariableKind::kElasticEnergy:
      return energy.elastic;
    case VariableKind::kGravityEnergy:
      return energy.gravity;
    case VariableKind::kDissipatedEnergy:
      return energy.dissipated;
    case VariableKind::kPortWork:
      return energy.port_work;
    case VariableKind::kSwitchingEnergy:
      return energy.switching;
    default:
      return energy.total();
  }
}

}  // namespace

double value_of(const Variable& variable, const World& world, const Energy& energy) noexcept {
  CORDIS_ASSERT(!is_count(variable.quantity));
  if (variable.take != Take::kOne) return value_of_many(variable, world, energy);
  if (is_of_body(variable.quantity)) return value_of_body(variable, world);
  if (is_of_link(variable.quantity)) return value_of_link(variable, world);
  switch (variable.quantity) {
    case VariableKind::kPosition:
      return variable.direction.dot(world.position(variable.index)) - variable.offset;
    case VariableKind::kVelocity:
      return variable.direction.dot(world.velocity(variable.index));
    case VariableKind::kForce:
      return variable.direction.dot(world.link_force(variable.index));
    case VariableKind::kSpeed:
      return world.velocity(variable.index).norm();
    case VariableKind::kContactForce:
      return variable.direction.dot(world.contact_force(variable.index));
    case VariableKind::kTime:
      return static_cast<double>(world.step_count()) * world.network().step();
    case VariableKind::kChanges:
      return static_cast<double>(world.total_change_count());
    case VariableKind::kAwake:
      return awake_in(world);
    default:
      return energy_of(variable.quantity, energy);
  }
}

void read_variables(std::span<const Variable> variables, const World& world,
                    std::span<double> values) noexcept {
  CORDIS_ASSERT(values.size() == variables.size());
  const bool wants_energy = std::ranges::any_of(
      variables, [](const Variable& variable) { return is_energy(variable.quantity); });
  const Energy energy = wants_energy ? world.energy() : Energy{};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    values[i] = value_of(variables[i], world, energy);
  }
}

}  // namespace cordis::engine
