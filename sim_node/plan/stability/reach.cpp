// sim_node/plan/stability/reach.cpp
#include "sim_node/plan/stability/reach.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/links/bend_shape.h"
#include "sim_node/plan/stability/bend_slope.h"
#include "sim_node/plan/stability/drive_extremes.h"
#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/parameter_bounds.h"
#include "sim_node/plan/stability/scene_box.h"
#include "sim_node/plan/stability/set_slope.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/stability/switching.h"

namespace cordis::plan {
namespace {

using engine::LiaisonKind;

constexpr double kMinSpeed = 1.0;  // [m/s]

double weight_of(const engine::NetworkDescription& network) {
  double weight = 0.0;
  for (const engine::Mat& mat : network.mats) {
    if (mat.kind == engine::MatKind::kMass) weight += mat.mass * network.gravity_on(mat).norm();
  }
  return weight;
}

/// True if a link, a bend or a set has a law that the energy of the scene may have to bound, or surfaces that a ball
/// may pass.
bool needs_energy(const engine::NetworkDescription& network) {
  const auto is_free = [](const engine::Law& law) {
    return std::holds_alternative<engine::Power>(law) ||
           std::holds_alternative<engine::Expression>(law) ||
           std::holds_alternative<engine::LennardJones>(law);
  };
  const auto needs = [&](const auto& liaison) {
    return std::ranges::any_of(network.state_machines[liaison.state_machine].states,
                               [&](const engine::LinkState& state) {
                                 return is_free(state.elasticity) || is_free(state.dissipation);
                               });
  };
  const auto may_be_passed = [&](const engine::SetLiaison& set) {
    return engine::acts_on_surfaces(network, set) && std::isfinite(flips_at(network, set));
  };
  const auto needs_of_bend = [&](const engine::Bend& bend) {
    return bend.has_states() && has_laws_of_bends(network.state_machines[bend.state_machine]);
  };
  return std::ranges::any_of(network.state_links, needs) ||
         std::ranges::any_of(network.bends, needs_of_bend) ||
         std::ranges::any_of(network.sets, needs) ||
         std::ranges::any_of(network.sets, may_be_passed);
}

/// What the pairs of a set bring in [J].
struct BroughtBySet {
  double stored = 0.0;  // at the start
  double fall = 0.0;    // see brought_by_pairs()
};

BroughtBySet brought_by_set(const engine::NetworkDescription& network,
                            const engine::SetLiaison& set, const Reach& reach) {
  const StartPairs near(network, set);
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const Reach of_masses =
      reach_between(reach, network, set.set_p, set.set_q.empty() ? set.set_p : set.set_q);
  BroughtBySet brought;
  double nearest = set.range;
  for (const StartPair& pair : near.pairs()) {
    const engine::LawPoint point = start_point(network, set, pair);
    brought.stored += max_stored_in(state_machine, point, of_masses);
    nearest = std::min(nearest, pair.distance);
  }
  const NearestPairs start{nearest, smallest_rest_of(network, set), all_begin_within(set, near)};
  brought.fall = brought_by_pairs(network, set, start, of_masses);
  return brought;
}

/// The first of two MATs if it is a mass, else the second.
std::uint32_t mass_of(const engine::NetworkDescription& network, std::uint32_t a, std::uint32_t b) {
  return network.mats[a].kind == engine::MatKind::kMass ? a : b;
}

/// Adds what the springs of friction store at the start, each at one of its MATs.
void add_stored_by_friction(const engine::NetworkDescription& network,
                            const engine::SetLiaison& set, std::vector<double>& stored) {
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const double stiffness = friction_in(state_machine, state_machine.start).stiffness;
  for (const engine::StartStretch& contact : set.stretches) {
    const std::uint32_t mat =
        mass_of(network, mat_of(set, contact.member_a), mat_of(set, contact.member_b));
    stored[mat] += 0.5 * stiffness * contact.stretch.squaredNorm();
  }
}

/// Adds what all but links with states and pairs of sets store, each at one of its MATs: at a mass, if there is one.
/// @param reach  its variables alone
void add_stored_at_start(const engine::NetworkDescription& network, const Reach& reach,
                         std::vector<double>& stored) {
  const auto at_mass = [&](std::uint32_t a, std::uint32_t b) -> double& {
    return stored[mass_of(network, a, b)];
  };
  for (const engine::Link& link : network.links) {
    const double e = distance_at_start(network, link.mat_a, link.mat_b) - link.rest_length;
    at_mass(link.mat_a, link.mat_b) += 0.5 * link.stiffness * e * e;
  }
  for (const engine::MaxwellLink& link : network.maxwell_links) {
    if (link.start_force == 0.0) continue;
    const double softest = linear_bounds(network, link, reach).stiffness.low;
    at_mass(link.mat_a, link.mat_b) += 0.5 * link.start_force * link.start_force / softest;
  }
  for (const engine::Bend& bend : network.bends) {
    double& here = stored[mass_of(network, mass_of(network, bend.mat_a, bend.mat_b), bend.mat_c)];
    if (bend.has_states()) here += brought_by_laws(network, bend);
    const double w = engine::bend_at_start(network, bend).norm();
    const double stiffest = linear_bounds(network, bend, reach).stiffness.high;
    if (!std::isfinite(stiffest)) continue;  // then nothing is certain of it
    here +=
        0.5 * stiffest *
        (bend.has_states() ? std::max(4.0, w * w) : w * w);  // a change may fold it the other way
  }
  for (const engine::SetLiaison& set : network.sets) add_stored_by_friction(network, set, stored);
}

/// Kinetic, and what falling through the scene brings [J].
double energy_brought(const engine::NetworkDescription& network) {
  double energy = 0.0;
  for (const engine::Mat& mat : network.mats) {
    if (mat.kind == engine::MatKind::kMass) energy += 0.5 * mat.mass * mat.velocity.squaredNorm();
  }
  const std::vector<double> falls = falls_of(network);
  return std::accumulate(falls.begin(), falls.end(), energy);
}

/// The first Maxwell element, bend or set whose elasticity follows a variable.
std::optional<engine::LiaisonId> fed_beside_links(const engine::NetworkDescription& network) {
  const auto first_of = [&](const auto& liaisons,
                            LiaisonKind kind) -> std::optional<engine::LiaisonId> {
    for (std::uint32_t index = 0; index < liaisons.size(); ++index) {
      const std::uint32_t machine = liaisons[index].state_machine;
      if (machine < network.state_machines.size() && is_fed(network.state_machines[machine]))
        return engine::LiaisonId{kind, index};
    }
    return {};
  };
  if (const auto fed = first_of(network.maxwell_links, LiaisonKind::kMaxwellLink)) return fed;
  if (const auto fed = first_of(network.bends, LiaisonKind::kBend)) return fed;
  return first_of(network.sets, LiaisonKind::kSet);
}

/// A step above which a spring alone is unstable [s]: the stiffest for its masses, or the step of the network where
/// there is none.
double longest_step_of(const engine::NetworkDescription& network) {
  double highest = 0.0;  // K / m [1/s^2]
  const auto take = [&](std::uint32_t mat_a, std::uint32_t mat_b, double stiffness) {
    for (const std::uint32_t mat : {mat_a, mat_b}) {
      if (network.mats[mat].kind == engine::MatKind::kMass)
        highest = std::max(highest, stiffness / network.mats[mat].mass);
    }
  };
  for (const engine::Link& link : network.links) take(link.mat_a, link.mat_b, link.stiffness);
  for (const engine::StateLink& link : network.state_links) {
    for (const engine::LinkState& state : network.state_machines[link.state_machine].states)
      take(link.mat_a, link.mat_b, state.stiffness);
  }
  return highest > 0.0 ? 2.0 / std::sqrt(highest) : network.step;
}

/// The speed at which a state holds a force that lasts, by its viscosity [m/s].
double terminal_speed(const engine::LinkState& state, double force) {
  if (force <= 0.0) return 0.0;
  constexpr double kSlowest = 1e-6;  // [m/s]
  constexpr double kFastest = 1e9;
  double speed = kSlowest;
  for (; speed < kFastest; speed *= 2.0) {
    engine::LawPoint point;
    const auto holds = [&](double v) {
      point.speed = v;
      return std::abs(state.viscosity * v + viscous_tension(state.dissipation, point));
    };
    if (std::min(holds(speed), holds(-speed)) >= force) break;
  }
  return speed;
}

/// What links with states bring in: found once for all that are alike but for rounding.
class BroughtByLinks {
 public:
  double brought(const engine::NetworkDescription& network, const engine::StateLink& link) {
    const engine::LawPoint start = start_point(network, link);
    const Key key{link.state_machine, static_cast<float>(start.distance),
                  static_cast<float>(link.rest_length), start.mass_a, start.mass_b};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_.emplace(key, brought_by(network, link)).first->second;
  }

 private:
  using Key = std::tuple<std::uint32_t, float, float, double, double>;
  std::map<Key, double> known_;
};

}  // namespace

double energy_at(const Reach& reach) {
  const double inverse = (reach.mass_a.high > 0.0 ? 1.0 / reach.mass_a.high : 0.0) +
                         (reach.mass_b.high > 0.0 ? 1.0 / reach.mass_b.high : 0.0);
  const double meeting = inverse > 0.0 ? 2.0 * reach.speed * reach.speed / inverse : 0.0;
  constexpr double kSpare = 1.01;  // for the sum over the tension
  return kSpare * (reach.brought + meeting);
}

double approach_energy(const Reach& reach) noexcept {
  if (!reach.held) return reach.energy;
  // sqrt(m / 2) (v + w): the mass at w has the energy, and the port goes at v.
  const double root = std::sqrt(0.5 * std::max(reach.mass_a.high, reach.mass_b.high));
  const double both = std::sqrt(std::max(reach.energy, 0.0)) + root * reach.speed;
  return both * both;
}

double work_of_forces(const Reach& reach, double way) noexcept {
  return 2.0 * reach.force * way;
}

double relative_speed(const engine::LinkState& state, const Reach& reach) {
  const double with_energy = std::sqrt(2.0 * energy_at(reach) * reach.inverse_mass);
  const double with_port = reach.held ? with_energy + reach.speed : with_energy;
  const double driven = is_none(state.dissipation) ? 0.0 : terminal_speed(state, reach.force);
  return std::max(with_port, reach.speed) + driven;
}

Interval tension_between(const engine::Law& law, double distance, double elongation,
                         const Reach& reach) {
  if (engine::asks_for_variable(law)) {
    LinkBox box{{distance, distance}, {}, distance - elongation, reach.mass_a, reach.mass_b};
    box.variables = reach.variables.get();
    return values_of(std::get<engine::Expression>(law).program, box);
  }
  Interval all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double mass_a : {reach.mass_a.low, reach.mass_a.high}) {
    for (const double mass_b : {reach.mass_b.low, reach.mass_b.high}) {
      const double tension = elastic_tension(law, {distance, elongation, 0.0, mass_a, mass_b});
      all = {std::min(all.low, tension), std::max(all.high, tension)};
    }
  }
  return all;
}

Interval range_of_variable(const engine::NetworkDescription& network,
                           const engine::Variable& variable) {
  constexpr double kNoEnd = std::numeric_limits<double>::infinity();
  const bool is_one = variable.take == engine::Take::kOne;
  switch (variable.quantity) {
    case engine::VariableKind::kPosition: {
      if (!is_one || network.mats[variable.index].kind != engine::MatKind::kFixed) break;
      const double place =
          variable.direction.dot(network.mats[variable.index].position) - variable.offset;
      return {place, place};
    }
    case engine::VariableKind::kDistance:
      if (network.dimension == 1) break;
      return {0.0, kNoEnd};
    case engine::VariableKind::kSpeed:
    case engine::VariableKind::kAge:
    case engine::VariableKind::kTime:
    case engine::VariableKind::kChanges:
    case engine::VariableKind::kKineticEnergy:
    case engine::VariableKind::kState:
      return {0.0, kNoEnd};
    case engine::VariableKind::kAwake:
      return {0.0, 1.0};
    default:
      break;
  }
  return kAnyNumber;
}

Reach reach_of(const engine::NetworkDescription& network, double factor) {
  Reach reach;
  reach.factor = factor;
  if (std::ranges::any_of(network.state_machines, engine::laws_ask_for_variable)) {
    std::vector<Interval> ranges;
    for (const engine::Variable& variable : network.variables)
      ranges.push_back(range_of_variable(network, variable));
    reach.variables = std::make_shared<const std::vector<Interval>>(std::move(ranges));
  }
  const Reach of_variables = reach;
  std::vector<double> stored(network.mats.size(), 0.0);
  add_stored_at_start(network, of_variables, stored);
  const double port_speed = std::max(kMinSpeed, largest_drive_speed(network));
  reach.speed = port_speed;
  std::uint32_t index = 0;
  BroughtByLinks known;
  for (const engine::StateLink& link : network.state_links) {
    const double distance =
        (network.mats[link.mat_b].position - network.mats[link.mat_a].position).norm();
    reach.elongation = std::max({reach.elongation, distance, std::abs(link.rest_length)});
    const bool feeds = is_fed(network.state_machines[link.state_machine]);
    if (feeds && !reach.fed) reach.fed = engine::LiaisonId{LiaisonKind::kStateLink, index};
    const double brought = feeds ? 0.0 : known.brought(network, link);
    if (std::isfinite(brought)) {
      stored[mass_of(network, link.mat_a, link.mat_b)] += brought;
    } else if (!reach.endless) {
      reach.endless = index;
    }
    ++index;
  }
  for (const engine::SetLiaison& set : network.sets) {
    reach.elongation = std::max(reach.elongation, set.range);
  }
  if (!reach.fed) reach.fed = fed_beside_links(network);
  for (const engine::Mat& mat : network.mats) {
    if (mat.kind != engine::MatKind::kMass) continue;
    reach.speed = std::max(reach.speed, mat.velocity.norm());
    reach.energy = std::max(reach.energy, mat.mass * mat.velocity.squaredNorm());
  }
  const double driven = sum_of_drive_forces(network);
  reach.driven = driven;
  reach.pushed = factor * driven * diagonal_of(network);
  reach.force = driven + weight_of(network);
  const double all_stored = std::accumulate(stored.begin(), stored.end(), 0.0);
  reach.brought = factor * (energy_brought(network) + all_stored) + reach.pushed;
  reach.counts_sets = needs_energy(network);
  for (const engine::SetLiaison& set : network.sets) {
    if (!reach.counts_sets) break;
    const BroughtBySet brought = brought_by_set(network, set, of_variables);
    reach.in_pairs += factor * brought.stored;
    reach.falls += factor * brought.fall;
    reach.brought += factor * (brought.stored + brought.fall);
  }
  reach.energy *= factor;
  reach.speed *= std::sqrt(factor);
  reach.longest_step = longest_step_of(network);
  const Switching switching = switching_of(network, reach);
  reach.switched = switching.endless;
  reach.brought += switching.all;
  for (std::size_t mat = 0; mat < stored.size(); ++mat)
    stored[mat] += switching.at_mats[mat] / factor;
  std::vector<EnergyShare> shares = energy_shares(network, stored, port_speed);
  for (EnergyShare& share : shares) {
    share = {factor * share.of_bodies, factor * share.stored + reach.pushed, factor * share.struck};
  }
  reach.shares = std::make_shared<const std::vector<EnergyShare>>(std::move(shares));
  return reach;
}

Reach reach_between(Reach reach, const engine::NetworkDescription& network,
                    const std::vector<std::uint32_t>& mats_a,
                    const std::vector<std::uint32_t>& mats_b) {
  reach.inverse_mass = 0.0;
  const auto masses = [&](const std::vector<std::uint32_t>& mats) {
    Interval range{std::numeric_limits<double>::infinity(), 0.0};
    double most = 0.0;  // of 1 / m
    for (const std::uint32_t mat : mats) {
      const bool is_mass = network.mats[mat].kind == engine::MatKind::kMass;
      const double mass = is_mass ? network.mats[mat].mass : 0.0;
      range = {std::min(range.low, mass), std::max(range.high, mass)};
      if (is_mass) most = std::max(most, 1.0 / mass);
      reach.held = reach.held || network.mats[mat].kind == engine::MatKind::kPort;
    }
    reach.inverse_mass += most;
    return range;
  };
  reach.mass_a = masses(mats_a);
  reach.mass_b = masses(mats_b);
  EnergyShare share;
  for (const auto* mats : {&mats_a, &mats_b}) {
    for (const std::uint32_t mat : *mats) {
      if (reach.shares == nullptr) continue;
      const EnergyShare& of_mat = (*reach.shares)[mat];
      share = {std::max(share.of_bodies, of_mat.of_bodies), std::max(share.stored, of_mat.stored),
               std::max(share.struck, of_mat.struck)};
    }
  }
  if (reach.shares == nullptr) return reach;
  reach.energy = std::min(share.of_bodies + share.stored, reach.brought);
  reach.struck = share.struck;
  if (!reach.held) reach.energy += reach.struck;  // a port meets it at its own speed
  return reach;
}

Reach reach_of_link(const Reach& reach, const engine::NetworkDescription& network,
                    std::uint32_t mat_a, std::uint32_t mat_b) {
  Reach here = reach_between(reach, network, {mat_a}, {mat_b});
  if (reach.shares != nullptr) here.energy = reach.brought + (here.held ? 0.0 : here.struck);
  return here;
}

}  // namespace cordis::plan
