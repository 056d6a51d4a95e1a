// sim_node/plan/reach_limit.cpp
#include "sim_node/plan/reach_limit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <variant>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/bend_slope.h"
#include "sim_node/plan/stability/partner_limit.h"
#include "sim_node/plan/stability/set_slope.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

/// True if K' + 2 Z' is below 4. Precondition: the integrator is not `modal`.
bool is_stable(const NetworkDescription& network, const LiaisonGraph& graph) {
  return network.step < certified_bound(network, graph).step;
}

bool is_certified(const NetworkDescription& network, const LiaisonGraph& graph) {
  if (network.integrator == engine::IntegratorKind::kModal)
    return stability_of(network, graph).holds();
  return !uncertainty_of(network, graph) && is_stable(network, graph);
}

/// The largest factor of an energy, at least 1 and to `finest` of it, up to which `holds` is true. The last factor
/// for which it was true is the one found.
template <class Holds>
double largest_factor(const Holds& holds, double finest, double largest = 1e6) {
  constexpr double kStep = 4.0;
  double low = 1.0;
  while (low < largest && holds(kStep * low)) low *= kStep;
  double high = low < largest ? kStep * low : low;
  while (high > finest * low) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

/// The energy up to which a state was followed within its reach [J].
double energy_followed(const engine::LinkState& state, double rest_length, bool turns,
                       const Reach& reach) {
  const double energy = energy_at(reach);
  if (!is_none(state.dissipation)) return energy;
  if (is_none(state.elasticity)) return std::numeric_limits<double>::infinity();
  if (reach.force == 0.0) return energy;
  const Stretch stretch = stretch_within(state, rest_length, turns, reach);
  if (!stretch.confined) return energy;
  return energy + work_of_forces(reach, std::min(stretch.longer, stretch.shorter));
}

/// Likewise a liaison.
double energy_followed(const engine::StateMachine& state_machine, double rest_length, bool turns,
                       const Reach& reach) {
  double energy = std::numeric_limits<double>::infinity();
  for (const engine::LinkState& state : state_machine.states) {
    energy = std::min(energy, energy_followed(state, rest_length, turns, reach));
    const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity);
    if (balls != nullptr) energy = std::min(energy, std::max(balls->well_depth, reach.energy));
  }
  return energy;
}

/// True if Lennard-Jones alone has no largest slope among the laws of a liaison: its slope depends on the energy
/// with which two balls meet, and on nothing else.
bool is_of_balls(const engine::StateMachine& state_machine) {
  const auto is_free = [](const engine::Law& law) {
    return std::holds_alternative<engine::Power>(law) ||
           std::holds_alternative<engine::Expression>(law);
  };
  const auto are_balls = [](const engine::LinkState& state) {
    return std::holds_alternative<engine::LennardJones>(state.elasticity);
  };
  return std::ranges::any_of(state_machine.states, are_balls) &&
         std::ranges::none_of(state_machine.states, [&](const engine::LinkState& state) {
           return is_free(state.elasticity) || is_free(state.dissipation);
         });
}

/// The energy below which the slope of Lennard-Jones is not looked at [J].
double deepest_well(const engine::StateMachine& state_machine) {
  double depth = 0.0;
  for (const engine::LinkState& state : state_machine.states) {
    const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity);
    if (balls != nullptr) depth = std::max(depth, balls->well_depth);
  }
  return depth;
}

/// The energies of the pairs of sets of balls, from that of the start or from that of their wells.
class PairEnergies {
 public:
  PairEnergies(const NetworkDescription& network, const LiaisonGraph& graph)
      : network_(network), graph_(graph) {
    for (const ContactBound& contact : graph.contacts) {
      const engine::SetLiaison& set = network.sets[contact.set];
      const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
      if (contact.bounded || !contact.counted || !is_of_balls(state_machine)) continue;
      if (!limits_.empty() && limits_.back().set == contact.set) continue;  // its other side
      starts_.push_back(set_start_of(network, set, graph.reach));
      limits_.push_back(
          {contact.set, std::max(deepest_well(state_machine), starts_.back().reach.energy)});
    }
  }

  /// Raised from the wells as far as the step is stable, all together; none where it is not stable there.
  std::vector<PairLimit> find_stable() {
    constexpr double kLargest = 1e12;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const engine::SetLiaison& set = network_.sets[limits_[k].set];
      set_energy(k, deepest_well(network_.state_machines[set.state_machine]));
    }
    if (limits_.empty() || !is_stable(network_, graph_)) return {};
    std::vector<std::size_t> all(limits_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    raise(all, is_stable, kLargest);
    return limits_;
  }

  /// Raised as far as the step is certified. All together, then one after the other; of too many all together alone.
  const std::vector<PairLimit>& find() {
    constexpr double kWork = 1e6;  // sets times what a bound goes through
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < limits_.size(); ++k) all.push_back(k);
    if (all.empty()) return limits_;
    raise(all, is_certified);
    if (all.size() == 1) return limits_;
    double size = static_cast<double>(graph_.edges.size() + graph_.inverse_mass.size());
    for (const ContactBound& contact : graph_.contacts)
      size += static_cast<double>(contact.members.size());
    if (size * static_cast<double>(all.size()) > kWork) return limits_;
    for (const std::size_t k : all) raise({k}, is_certified);
    return limits_;
  }

 private:
  template <class Holds>
  void raise(const std::vector<std::size_t>& group, const Holds& holds, double largest = 1e6) {
    constexpr double kFinest = 1.05;
    const std::vector<PairLimit> before = limits_;
    const auto raise_by = [&](double factor) {
      for (const std::size_t k : group) set_energy(k, factor * before[k].energy);
    };
    raise_by(largest_factor(
        [&](double factor) {
          raise_by(factor);
          return holds(network_, graph_);
        },
        kFinest, largest));
  }

  void set_energy(std::size_t k, double energy) {
    limits_[k].energy = starts_[k].reach.energy = energy;
    const Slope slope = largest_slope_of(network_, network_.sets[limits_[k].set], starts_[k]);
    for (ContactBound& contact : graph_.contacts) {
      if (contact.set != limits_[k].set || !contact.counted) continue;
      contact.stiffness = slope.stiffness;
      contact.viscosity = slope.viscosity;
      contact.variation = slope.variation;
      contact.fall = slope.fall;
    }
  }

  const NetworkDescription& network_;
  LiaisonGraph graph_;
  std::vector<SetStart> starts_;  // of each limit
  std::vector<PairLimit> limits_;
};

/// The energies to which laws without a largest slope were followed in a graph.
ReachLimit limit_of(const NetworkDescription& network, const LiaisonGraph& graph) {
  ReachLimit limit;
  limit.speed = graph.reach.speed;
  const bool turns = network.dimension > 1;
  const SlopesOfBends bends(network, graph.reach);
  for (const Edge& edge : graph.edges) {
    if (edge.bounded) continue;
    if (edge.liaison.kind == engine::LiaisonKind::kBend) {
      limit.energy =
          std::min(limit.energy, bends.energy_followed(network.bends[edge.liaison.index]));
      continue;
    }
    const engine::StateLink& link = network.state_links[edge.liaison.index];
    const Reach here = reach_of_link(graph.reach, network, edge.mat_a, edge.mat_b);
    limit.energy = std::min(
        limit.energy,
        energy_followed(network.state_machines[link.state_machine], link.rest_length, turns, here));
  }
  limit.pairs = PairEnergies(network, graph).find();
  for (const ContactBound& contact : graph.contacts) {
    const engine::SetLiaison& set = network.sets[contact.set];
    const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
    if (contact.bounded || is_of_balls(state_machine)) continue;
    const Reach here = reach_between(graph.reach, network, contact.members, contact.others);
    const double barrier =
        largest_slope_of(network, set, set_start_of(network, set, graph.reach)).barrier;
    const double energy = std::min(
        barrier, energy_followed(state_machine, std::max(set.rest_length, 0.0), turns, here));
    if (limit.pairs.empty() || limit.pairs.back().set != contact.set)
      limit.pairs.push_back({contact.set, energy});
    limit.pairs.back().energy = std::min(limit.pairs.back().energy, energy);
  }
  return limit;
}

/// The two largest of some values.
struct TwoLargest {
  double first = 0.0;
  double second = 0.0;

  void add(double value) noexcept {
    second = std::max(second, std::min(first, value));
    first = std::max(first, value);
  }
  double sum() const noexcept { return first + second; }
};

/// How fast MATs are.
struct Motion {
  TwoLargest kinetic;     // energies [J]
  TwoLargest speed;       // [m/s]
  double heaviest = 0.0;  // [kg]; infinite where one is no mass
  bool has_port = false;
};

Motion motion_of(const engine::World& world, const std::vector<std::uint32_t>& mats) noexcept {
  Motion motion;
  for (const std::uint32_t index : mats) {
    const engine::Mat& mat = world.network().description().mats[index];
    motion.has_port = motion.has_port || mat.kind == engine::MatKind::kPort;
    if (mat.kind != engine::MatKind::kMass) {
      motion.heaviest = std::numeric_limits<double>::infinity();
      continue;
    }
    const double square = world.velocity(index).squaredNorm();
    motion.kinetic.add(0.5 * mat.mass * square);
    motion.speed.add(std::sqrt(square));
    motion.heaviest = std::max(motion.heaviest, mat.mass);
  }
  return motion;
}

constexpr std::uint32_t kNoMass = std::numeric_limits<std::uint32_t>::max();

/// The needed partners times this power of what they are certified to grow by; any number for what is no mass.
std::vector<SetPartners> partners_of(const NetworkDescription& network,
                                     const std::vector<PartnerLimit>& certified,
                                     const LiaisonGraph& needed, double share) {
  constexpr double kRounding = 1e-9;
  std::vector<SetPartners> all;
  for (const PartnerLimit& limit : certified) {
    all.push_back({limit.set, {}});
    std::vector<std::uint32_t>& partners = all.back().partners;
    for (const ContactBound& contact : needed.contacts) {
      if (contact.set != limit.set || !contact.counted) continue;
      for (std::size_t m = 0; m < contact.members.size(); ++m) {
        const double most = limit.certified[partners.size()];
        const double least = contact.neighbours[m];
        const double here =
            least > 0.0 && most > least ? least * std::pow(most / least, share) : most;
        const bool is_mass = network.mats[contact.members[m]].kind == engine::MatKind::kMass;
        partners.push_back(is_mass ? static_cast<std::uint32_t>(std::min(here + kRounding, most))
                                   : kNoMass);
      }
    }
  }
  return all;
}

/// The graph with at least these partners of masses.
LiaisonGraph with_partners(LiaisonGraph graph, const std::vector<SetPartners>& all) {
  for (const SetPartners& set : all) {
    std::size_t member = 0;
    for (ContactBound& contact : graph.contacts) {
      if (contact.set != set.set || !contact.counted) continue;
      for (double& partners : contact.neighbours) {
        const std::uint32_t here = set.partners[member++];
        if (here != kNoMass) partners = std::max<double>(partners, here);
      }
    }
  }
  return graph;
}

/// The graphs of a network by the factor of its energies, each made once.
class GraphsByEnergy {
 public:
  GraphsByEnergy(const NetworkDescription& network, LiaisonGraph start) : network_(network) {
    graphs_.emplace(1.0, std::move(start));
  }
  const LiaisonGraph& at(double factor) {
    const auto known = graphs_.find(factor);
    if (known != graphs_.end()) return known->second;
    return graphs_.emplace(factor, liaison_graph(network_, factor)).first->second;
  }

 private:
  const NetworkDescription& network_;
  std::map<double, LiaisonGraph> graphs_;
};

/// The limits with these partners, the energies raised as far as the step is certified. Those of the start hold.
ReachLimit limit_with(const NetworkDescription& network, GraphsByEnergy& graphs,
                      std::vector<SetPartners> partners) {
  constexpr double kFinest = 1.1;
  const double factor = largest_factor(
      [&](double trial) {
        return is_certified(network, with_partners(graphs.at(trial), partners));
      },
      kFinest);
  ReachLimit limit = limit_of(network, with_partners(graphs.at(factor), partners));
  limit.partners = std::move(partners);
  return limit;
}

/// True if no member of a set touches more others than these limits have.
bool has_room(const ReachLimit& limit, const engine::World& world) noexcept {
  return std::ranges::all_of(limit.partners, [&](const SetPartners& set) {
    for (std::size_t member = 0; member < set.partners.size(); ++member) {
      if (world.partners_of(set.set, member) > set.partners[member]) return false;
    }
    return true;
  });
}

}  // namespace

ReachLimit reach_limit(const NetworkDescription& network) {
  const LiaisonGraph start = liaison_graph(network);
  if (start.bounded || !is_certified(network, start)) return {};
  GraphsByEnergy graphs(network, start);
  ReachLimit limit = limit_with(network, graphs, {});
  if (limit.is_infinite()) return limit;
  const std::vector<PartnerLimit> certified = partner_limits(network, start, /*holds=*/true);
  limit.partners = partners_of(network, certified, start, 0.0);
  const std::vector<SetPartners>* before = &limit.partners;
  for (const double share : {0.5, 1.0}) {
    std::vector<SetPartners> partners = partners_of(network, certified, start, share);
    if (partners == *before) continue;
    limit.with_more_partners.push_back(limit_with(network, graphs, std::move(partners)));
    before = &limit.with_more_partners.back().partners;
  }
  return limit;
}

std::vector<PairLimit> stable_pairs(const NetworkDescription& network) {
  bool has_balls = false;
  for (const engine::SetLiaison& set : network.sets) {
    const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
    if (!is_of_balls(state_machine)) continue;
    has_balls = true;
    if (engine::laws_ask_for_variable(state_machine)) return {};
  }
  if (!has_balls || network.integrator == engine::IntegratorKind::kModal) return {};
  return PairEnergies(network, liaison_graph(network)).find_stable();
}

double pair_energy(const engine::World& world, const engine::SetLiaison& set) noexcept {
  const Motion p = motion_of(world, set.set_p);
  const bool is_within = set.set_q.empty();
  const Motion q = is_within ? p : motion_of(world, set.set_q);
  const double kinetic = is_within ? p.kinetic.sum() : p.kinetic.first + q.kinetic.first;
  if (p.has_port || q.has_port) return kinetic;
  const double speed = is_within ? p.speed.sum() : p.speed.first + q.speed.first;
  const double reduced_mass = 1.0 / (1.0 / p.heaviest + 1.0 / q.heaviest);
  return std::min(kinetic, 0.5 * reduced_mass * speed * speed);
}

bool is_beyond(const ReachLimit& of_scene, const engine::World& world,
               const engine::Energy& energy) noexcept {
  if (of_scene.is_infinite()) return false;
  const ReachLimit* limit = &of_scene;
  for (const ReachLimit& fuller : of_scene.with_more_partners) {
    if (has_room(*limit, world)) break;
    limit = &fuller;
  }
  const engine::NetworkDescription& network = world.network().description();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != engine::MatKind::kPort) continue;
    if (!(world.velocity(i).norm() <= limit->speed)) return true;
  }
  const double whole = energy.kinetic + std::max(energy.elastic, 0.0);
  if (!(whole <= limit->energy)) return true;
  return std::ranges::any_of(limit->pairs, [&](const PairLimit& pair) {
    return !(pair_energy(world, network.sets[pair.set]) <= pair.energy);
  });
}

}  // namespace cordis::plan
