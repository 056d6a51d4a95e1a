// sim_node/plan/reference/ode_system.cpp
#include "sim_node/plan/reference/ode_system.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim_node/engine/links/bend_moment.h"
#include "sim_node/engine/links/bend_shape.h"

namespace cordis::plan {
namespace {

using engine::Vec3;

constexpr double kMoment = 1e-3;  // of a step of the network: how much earlier a trend looks

Vec3 column(const OdeSystem::Values& values, std::size_t first, std::uint32_t mat) {
  return Vec3::Map(values.data() + first + 3 * static_cast<std::size_t>(mat));
}

/// True if a force depends on the place and the velocity of its MAT, and on nothing else that changes.
bool is_of_motion_alone(const engine::TimeFunction& function) {
  return function.time.empty() && !asks_for_variable(function) &&
         std::ranges::none_of(function.formula, [](const engine::Program& formula) {
           return asks_for(formula, engine::Quantity::kAge);
         });
}

void refuse_impulse(const engine::Program& program) {
  if (!asks_for(program, engine::Quantity::kImpulse)) return;
  throw std::invalid_argument("conditions on the impulse of a link have no reference integrator");
}

}  // namespace

/// A link at one moment.
struct OdeSystem::Geometry {
  double distance = 0.0;
  double speed = 0.0;
  Vec3 direction = Vec3::Zero();  // of unit length, or 0
  Vec3 velocity = Vec3::Zero();   // of b relative to a
};

OdeSystem::OdeSystem(engine::NetworkDescription network)
    : network_(std::move(network)), held_(network_.mats.size(), Vec3::Zero()) {
  for (const engine::Drive& drive : network_.drives) {
    const engine::TimeFunction& function = network_.time_functions[drive.function];
    if (!drive.is_force || !is_of_motion_alone(function))
      throw std::invalid_argument(
          "MATs that follow a function of time have no reference integrator");
  }
  for (const engine::StateMachine& state_machine : network_.state_machines) {
    if (rubs(state_machine)) throw std::invalid_argument("friction has no reference integrator");
    if (asks_for_variable(state_machine))
      throw std::invalid_argument(
          "conditions and laws that ask for other variables have no reference integrator");
    for (const engine::Transition& exit : state_machine.exits) {
      refuse_impulse(exit.when);
      refuse_impulse(exit.rest_length);
    }
  }
  for (const engine::StateLink& link : network_.state_links) {
    const engine::StateMachine& state_machine = network_.state_machines[link.state_machine];
    states_.push_back({state_machine.start, link.rest_length, -1.0});
    has_states_ = has_states_ || !state_machine.exits.empty();
  }
  for (const engine::Bend& bend : network_.bends) {
    bends_.push_back({0, bend.rest_angle, -1.0});
    if (!bend.has_states()) continue;
    const engine::StateMachine& state_machine = network_.state_machines[bend.state_machine];
    bends_.back().state = state_machine.start;
    has_states_ = has_states_ || !state_machine.exits.empty();
  }
  for (std::uint32_t s = 0; s < network_.sets.size(); ++s) {
    sets_.push_back({NearPairs(network_, s), {}});
    has_states_ =
        has_states_ || !network_.state_machines[network_.sets[s].state_machine].exits.empty();
  }
}

OdeSystem::Values OdeSystem::start() const {
  Values values(2 * position_count() + network_.maxwell_links.size(), 0.0);
  for (std::size_t i = 0; i < network_.mats.size(); ++i) {
    std::copy_n(network_.mats[i].position.data(), 3, values.data() + 3 * i);
    std::copy_n(network_.mats[i].velocity.data(), 3, values.data() + position_count() + 3 * i);
  }
  for (std::size_t l = 0; l < network_.maxwell_links.size(); ++l) {
    values[2 * position_count() + l] = network_.maxwell_links[l].start_force;
  }
  return values;
}

engine::Vec3 OdeSystem::position(const Values& values, std::uint32_t mat) const {
  return column(values, 0, mat);
}

engine::Vec3 OdeSystem::velocity(const Values& values, std::uint32_t mat) const {
  return column(values, position_count(), mat);
}

void OdeSystem::hold_force(std::uint32_t mat, const Vec3& force) {
  held_[mat] = force;
}

double OdeSystem::mass(std::uint32_t mat) const {
  return network_.mats[mat].kind == engine::MatKind::kMass ? network_.mats[mat].mass : 0.0;
}

OdeSystem::Joined OdeSystem::joined(std::uint32_t state_link) const {
  const engine::StateLink& link = network_.state_links[state_link];
  return {link.mat_a, link.mat_b, network_.state_machines[link.state_machine], states_[state_link],
          false};
}

OdeSystem::Joined OdeSystem::joined(std::uint32_t set, NearPairs::Pair pair,
                                    const Present& present) const {
  return {pair.first, pair.second, network_.state_machines[network_.sets[set].state_machine],
          present, true};
}

OdeSystem::Present OdeSystem::fresh(std::uint32_t set, NearPairs::Pair pair) const {
  const engine::SetLiaison& liaison = network_.sets[set];
  const double rest = liaison.rest_length < 0.0
                          ? network_.radius[pair.first] + network_.radius[pair.second]
                          : liaison.rest_length;
  return {network_.state_machines[liaison.state_machine].start, rest, -1.0};
}

/// All pairs that are in range or bound, each with what it remembers.
template <class Visit>
void OdeSystem::each_pair(std::uint32_t set, const Values& values, Visit visit) {
  Set& known = sets_[set];
  const double range = network_.sets[set].range;
  for (const NearPairs::Pair& pair : known.near.near(values.data())) {
    if (!known.bound.empty() && known.bound.contains(pair)) continue;
    const engine::Surface* surface = engine::surface_of(network_, pair.first);
    double distance = 0.0;
    if (surface != nullptr) {
      const engine::SurfaceDistance from = from_surface(*surface, values.data(), pair.second);
      if (from.is_beyond) continue;
      distance = from.distance;
    } else {
      distance = (position(values, pair.second) - position(values, pair.first)).norm();
    }
    if (distance < range && !visit(pair, fresh(set, pair))) return;
  }
  for (const auto& [pair, present] : known.bound) {
    if (!visit(pair, present)) return;
  }
}

OdeSystem::Geometry OdeSystem::geometry(const Values& values, const Joined& joined) const {
  Geometry link;
  const Vec3 along = position(values, joined.mat_b) - position(values, joined.mat_a);
  link.velocity = velocity(values, joined.mat_b) - velocity(values, joined.mat_a);
  const engine::Surface* surface =
      joined.of_set ? engine::surface_of(network_, joined.mat_a) : nullptr;
  if (surface != nullptr) {
    const engine::SurfaceDistance from = from_surface(*surface, values.data(), joined.mat_b);
    link.distance = from.distance;
    link.direction = from.normal;
  } else if (network_.dimension == 1 && !joined.of_set) {
    link.distance = along.x();
    link.direction = Vec3::UnitX();
  } else {
    link.distance = along.norm();
    if (link.distance > 0.0) link.direction = along / link.distance;
  }
  link.speed = link.direction.dot(link.velocity);
  return link;
}

double OdeSystem::tension(const Joined& joined, const Geometry& link) const {
  const engine::LinkState& state = joined.state_machine.states[joined.present.state];
  const double elongation = link.distance - joined.present.rest_length;
  engine::LawPoint point{link.distance, elongation, 0.0, mass(joined.mat_a), mass(joined.mat_b)};
  double tension = state.stiffness * elongation + state.viscosity * link.speed +
                   elastic_tension(state.elasticity, point);
  point.speed = link.speed;
  tension += viscous_tension(state.dissipation, point);
  if (!state.pulls) tension = std::min(tension, 0.0);
  if (!state.pushes) tension = std::max(tension, 0.0);
  return std::clamp(tension, -state.force_limit, state.force_limit);
}

void OdeSystem::rate(const Values& values, Values& rate) {
  const std::size_t n = position_count();
  rate.assign(values.size(), 0.0);
  const auto add_pair_force = [&](std::uint32_t a, std::uint32_t b, const Vec3& force) {
    Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(a)) += force;
    Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(b)) -= force;
  };
  static const engine::StateMachine kNone;
  static const Present kNothing;
  for (const engine::Link& link : network_.links) {
    const Geometry line = geometry(values, {link.mat_a, link.mat_b, kNone, kNothing, false});
    if (link.isotropic) {
      const Vec3 along = position(values, link.mat_b) - position(values, link.mat_a);
      add_pair_force(link.mat_a, link.mat_b,
                     link.stiffness * along + link.viscosity * line.velocity);
      continue;
    }
    const double tension =
        link.stiffness * (line.distance - link.rest_length) + link.viscosity * line.speed;
    add_pair_force(link.mat_a, link.mat_b, tension * line.direction);
  }
  for (std::uint32_t l = 0; l < states_.size(); ++l) {
    const Joined link = joined(l);
    const Geometry line = geometry(values, link);
    add_pair_force(link.mat_a, link.mat_b, tension(link, line) * line.direction);
  }
  for (std::uint32_t s = 0; s < sets_.size(); ++s) {
    each_pair(s, values, [&](NearPairs::Pair pair, const Present& present) {
      const Joined link = joined(s, pair, present);
      const Geometry line = geometry(values, link);
      add_pair_force(pair.first, pair.second, tension(link, line) * line.direction);
      return true;
    });
  }
  for (std::size_t l = 0; l < network_.maxwell_links.size(); ++l) {
    const engine::MaxwellLink& link = network_.maxwell_links[l];
    const Geometry line = geometry(values, {link.mat_a, link.mat_b, kNone, kNothing, false});
    const double force = values[2 * n + l];
    add_pair_force(link.mat_a, link.mat_b, force * line.direction);
    rate[2 * n + l] = link.stiffness * (line.speed - force / link.viscosity);
  }
  for (std::uint32_t b = 0; b < network_.bends.size(); ++b) {
    const engine::Bend bend = present_bend(b);
    const engine::BendShape shape(bend, network_.dimension);
    const Vec3 turning = moment(b, bend, sides(values, bend));
    add_pair_force(bend.mat_a, bend.mat_b, shape.force_on_a(turning));
    add_pair_force(bend.mat_c, bend.mat_b, shape.force_on_c(turning));
  }
  for (const engine::Drive& drive : network_.drives) {
    Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(drive.mat)) += force_at(
        network_, drive, {0.0, position(values, drive.mat), velocity(values, drive.mat), nullptr});
  }
  for (std::uint32_t i = 0; i < network_.mats.size(); ++i) {
    auto acceleration = Vec3::Map(rate.data() + n + 3 * static_cast<std::size_t>(i));
    const Vec3 v = velocity(values, i);
    Vec3::Map(rate.data() + 3 * static_cast<std::size_t>(i)) = v;
    if (network_.mats[i].kind != engine::MatKind::kMass) {
      acceleration.setZero();
      continue;
    }
    acceleration = (acceleration + held_[i] - network_.medium_viscosity_on(network_.mats[i]) * v) /
                       network_.mats[i].mass +
                   network_.gravity_on(network_.mats[i]);
  }
}

engine::LinkQuantities OdeSystem::quantities(const Joined& joined, double time,
                                             const Geometry& link) const {
  return {link.distance,
          link.distance - joined.present.rest_length,
          link.speed,
          link.velocity.x(),
          link.velocity.y(),
          link.velocity.z(),
          (link.velocity - link.speed * link.direction).norm(),
          tension(joined, link),
          0.0,
          time - std::max(joined.present.entered, 0.0),
          joined.present.rest_length,
          mass(joined.mat_a),
          mass(joined.mat_b)};
}

engine::Bend OdeSystem::present_bend(std::uint32_t index) const {
  engine::Bend bend = network_.bends[index];
  if (!bend.has_states()) return bend;
  const engine::LinkState& state =
      network_.state_machines[bend.state_machine].states[bends_[index].state];
  bend.stiffness = state.stiffness;
  bend.viscosity = state.viscosity;
  bend.rest_angle = bends_[index].rest_length;
  return bend;
}

engine::BendSides OdeSystem::sides(const Values& values, const engine::Bend& bend) const {
  return {position(values, bend.mat_b) - position(values, bend.mat_a),
          position(values, bend.mat_c) - position(values, bend.mat_b),
          velocity(values, bend.mat_b) - velocity(values, bend.mat_a),
          velocity(values, bend.mat_c) - velocity(values, bend.mat_b)};
}

engine::Vec3 OdeSystem::moment(std::uint32_t index, const engine::Bend& bend,
                               const engine::BendSides& sides) const {
  const int dimension = network_.dimension;
  const Vec3 linear = engine::moment_of(bend, dimension, sides);
  if (!bend.has_states()) return linear;
  const engine::LawsOfBend laws =
      engine::laws_of_bend(network_.state_machines[bend.state_machine].states[bends_[index].state]);
  if (!laws.any()) return linear;
  const engine::BendShape shape(bend, dimension);
  const auto bend_vector = [&](const Vec3& u, const Vec3& v) {
    return shape(Vec3::Zero(), u, u + v);
  };
  const Vec3 rate =
      bend_vector(sides.rate_u, sides.rate_v) - bend_vector(Vec3::Zero(), Vec3::Zero());
  const engine::BendOfLaw seen =
      engine::bend_of_law(bend_vector(sides.u, sides.v), rate, dimension);
  const engine::MomentOfLaws of_laws = moment_of_laws(laws, seen, nullptr);
  return linear + (of_laws.elastic + of_laws.viscous) * seen.direction;
}

engine::LinkQuantities OdeSystem::quantities(std::uint32_t index, double time,
                                             const Values& values) const {
  const engine::Bend bend = present_bend(index);
  const int dimension = network_.dimension;
  const engine::BendSides found = sides(values, bend);
  const engine::AngleAndRate angle = engine::angle_of(bend, dimension, found);
  engine::LinkQuantities now{};
  const auto put = [&now](engine::Quantity quantity, double value) {
    now[static_cast<std::size_t>(quantity)] = value;
  };
  put(engine::Quantity::kAngle, angle.angle);
  put(engine::Quantity::kBend, engine::angle_beyond(bend.rest_angle, angle.angle, dimension));
  put(engine::Quantity::kAngularSpeed, angle.rate);
  put(engine::Quantity::kMoment,
      engine::moment_about_middle(bend, dimension, found, moment(index, bend, found)));
  put(engine::Quantity::kRestAngle, bend.rest_angle);
  put(engine::Quantity::kAge, time - std::max(bends_[index].entered, 0.0));
  return now;
}

std::int64_t OdeSystem::exit_of_bend(std::uint32_t index, double time, const Values& values) {
  if (!network_.bends[index].has_states()) return -1;
  const engine::StateMachine& state_machine =
      network_.state_machines[network_.bends[index].state_machine];
  const engine::LinkState& state = state_machine.states[bends_[index].state];
  if (state.first_exit == state.last_exit) return -1;
  const engine::LinkQuantities now = quantities(index, time, values);
  for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
    const engine::Program& when = state_machine.exits[e].when;
    if (has_edge(when) && time > std::max(bends_[index].entered, 0.0)) {
      const engine::LinkQuantities before = quantities(index, time, earlier(time, values));
      if (value_of(when, now, &before) != 0.0) return e;
    } else if (value_of(when, now) != 0.0) {
      return e;
    }
  }
  return -1;
}

void OdeSystem::change_bend(std::uint32_t index, double time, const Values& values) {
  const std::int64_t exit_index = exit_of_bend(index, time, values);
  if (exit_index < 0) return;
  const engine::StateMachine& state_machine =
      network_.state_machines[network_.bends[index].state_machine];
  const engine::Transition& exit = state_machine.exits[static_cast<std::size_t>(exit_index)];
  const engine::LinkQuantities now = quantities(index, time, values);
  Present& present = bends_[index];
  if (exit.rest == engine::RestRule::kExpression) {
    present.rest_length = value_of(exit.rest_length, now);
  } else if (exit.rest == engine::RestRule::kHere) {
    present.rest_length = now[static_cast<std::size_t>(engine::Quantity::kAngle)];
  } else if (state_machine.states[exit.target].rest_angle) {
    present.rest_length = *state_machine.states[exit.target].rest_angle;
  }
  present.state = exit.target;
  present.entered = time;
}

const OdeSystem::Values& OdeSystem::earlier(double time, const Values& values) {
  if (earlier_is_known_) return earlier_;
  const double moment = kMoment * network_.step;
  rate(values, rate_);
  earlier_.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) earlier_[i] = values[i] - moment * rate_[i];
  earlier_is_known_ = time >= 0.0;
  return earlier_;
}

std::int64_t OdeSystem::exit_of(const Joined& joined, double time, const Values& values) {
  const engine::LinkState& state = joined.state_machine.states[joined.present.state];
  if (state.first_exit == state.last_exit) return -1;
  const engine::LinkQuantities now = quantities(joined, time, geometry(values, joined));
  for (std::uint32_t e = state.first_exit; e < state.last_exit; ++e) {
    const engine::Program& when = joined.state_machine.exits[e].when;
    // A trend is not known yet at the moment in which the state is entered, nor at the start.
    if (has_edge(when) && time > std::max(joined.present.entered, 0.0)) {
      const engine::LinkQuantities before =
          quantities(joined, time, geometry(earlier(time, values), joined));
      if (value_of(when, now, &before) != 0.0) return e;
    } else if (value_of(when, now) != 0.0) {
      return e;
    }
  }
  return -1;
}

std::optional<OdeSystem::Change> OdeSystem::next_change(double time, const Values& values) {
  earlier_is_known_ = false;
  for (std::uint32_t l = 0; l < states_.size(); ++l) {
    if (exit_of(joined(l), time, values) >= 0) return Change{l, {}, 0, {}};
  }
  for (std::uint32_t b = 0; b < bends_.size(); ++b) {
    if (exit_of_bend(b, time, values) >= 0) return Change{{}, b, 0, {}};
  }
  std::optional<Change> found;
  for (std::uint32_t s = 0; s < sets_.size() && !found; ++s) {
    if (network_.state_machines[network_.sets[s].state_machine].exits.empty()) continue;
    each_pair(s, values, [&](NearPairs::Pair pair, const Present& present) {
      if (exit_of(joined(s, pair, present), time, values) >= 0) found = Change{{}, {}, s, pair};
      return !found;
    });
  }
  return found;
}

void OdeSystem::change(const Change& change, double time, const Values& values) {
  earlier_is_known_ = false;
  if (change.bend) {
    change_bend(*change.bend, time, values);
    return;
  }
  Present present;
  if (change.state_link) {
    present = states_[*change.state_link];
  } else {
    const auto bound = sets_[change.set].bound.find(change.pair);
    present =
        bound != sets_[change.set].bound.end() ? bound->second : fresh(change.set, change.pair);
  }
  const Joined link =
      change.state_link ? joined(*change.state_link) : joined(change.set, change.pair, present);
  const std::int64_t exit_index = exit_of(link, time, values);
  if (exit_index < 0) return;
  const engine::Transition& exit = link.state_machine.exits[static_cast<std::size_t>(exit_index)];
  const Geometry line = geometry(values, link);
  if (exit.rest == engine::RestRule::kExpression) {
    present.rest_length = value_of(exit.rest_length, quantities(link, time, line));
  } else if (exit.rest == engine::RestRule::kHere) {
    present.rest_length = line.distance;
  }
  present.state = exit.target;
  present.entered = time;
  if (change.state_link) {
    states_[*change.state_link] = present;
  } else if (present.state == link.state_machine.start) {
    sets_[change.set].bound.erase(change.pair);
  } else {
    sets_[change.set].bound[change.pair] = present;
  }
}

}  // namespace cordis::plan
