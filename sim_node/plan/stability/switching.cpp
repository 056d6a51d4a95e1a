// sim_node/plan/stability/switching.cpp
#include "sim_node/plan/stability/switching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "sim_node/engine/links/bend_angle.h"
#include "sim_node/plan/stability/entry.h"
#include "sim_node/plan/stability/set_slope.h"
#include "sim_node/plan/stability/start_point.h"

namespace cordis::plan {
namespace {

using engine::LiaisonId;
using engine::LiaisonKind;
using engine::NetworkDescription;

/// So many rest lengths of links of one liaison count each on their own.
constexpr std::size_t kRestLengths = 16;

/// Links, or the pairs of a set, that count alike.
struct Kind {
  LiaisonId first;
  engine::StateMachine state_machine = {};
  double rest_length = 0.0;         // [m]
  Interval possible = kAnyNumber;   // elongations [m]
  Reach reach = {};                 // without what changes of state bring in
  std::vector<double> counts = {};  // per MAT: how many of them count at it
  double count = 0.0;               // of all

  /// What one of them brings in where the scene has so much more energy [J].
  double brought(double more) const {
    Reach here = reach;
    here.brought += more;
    double most = 0.0;
    for (const Entry& entry : entries_of(state_machine, rest_length, possible, here))
      most = std::max(most, entry.brought);
    return most;
  }
  /// Takes in others that differ by where they begin.
  void join(const Kind& other) {
    const Interval& theirs = other.reach.begins;
    reach.begins = {std::min(reach.begins.low, theirs.low),
                    std::max(reach.begins.high, theirs.high)};
    reach.elongation = std::max(reach.elongation, other.reach.elongation);
    reach.held = reach.held || other.reach.held;
    for (std::size_t mat = 0; mat < counts.size(); ++mat) counts[mat] += other.counts[mat];
    count += other.count;
  }
  void add_at(std::uint32_t mat, double number) {
    counts[mat] += number;
    count += number;
  }
};

bool is_free_mass(const NetworkDescription& network, std::uint32_t mat) {
  return network.mats[mat].kind == engine::MatKind::kMass;
}

/// The links of one liaison, by rest length where there are few.
using LinksByKind = std::map<std::pair<std::uint32_t, float>, std::vector<std::uint32_t>>;

LinksByKind links_by_kind(const NetworkDescription& network) {
  LinksByKind kinds;
  for (std::uint32_t l = 0; l < network.state_links.size(); ++l) {
    const engine::StateLink& link = network.state_links[l];
    if (network.state_machines[link.state_machine].exits.empty()) continue;
    kinds[{link.state_machine, static_cast<float>(link.rest_length)}].push_back(l);
  }
  std::map<std::uint32_t, std::size_t> lengths;
  for (const auto& [key, links] : kinds) ++lengths[key.first];
  LinksByKind merged;
  for (const auto& [key, links] : kinds) {
    const bool is_one_of_few = lengths[key.first] <= kRestLengths;
    auto& all = merged[{key.first, is_one_of_few ? key.second : 0.0F}];
    all.insert(all.end(), links.begin(), links.end());
  }
  return merged;
}

Kind kind_of(const NetworkDescription& network, const std::vector<std::uint32_t>& links,
             const Reach& reach) {
  const engine::StateLink& first = network.state_links[links.front()];
  Kind kind{{LiaisonKind::kStateLink, links.front()},
            network.state_machines[first.state_machine],
            first.rest_length};
  kind.possible = possible_elongations(first.rest_length, network.dimension > 1);
  kind.counts.assign(network.mats.size(), 0.0);
  std::vector<std::uint32_t> mats_a;
  std::vector<std::uint32_t> mats_b;
  Interval begins{start_point(network, first).elongation, start_point(network, first).elongation};
  bool rests_differ = false;
  for (const std::uint32_t l : links) {
    const engine::StateLink& link = network.state_links[l];
    const double elongation = start_point(network, link).elongation;
    begins = {std::min(begins.low, elongation), std::max(begins.high, elongation)};
    rests_differ = rests_differ ||
                   static_cast<float>(link.rest_length) != static_cast<float>(first.rest_length);
    mats_a.push_back(link.mat_a);
    mats_b.push_back(link.mat_b);
    kind.add_at(is_free_mass(network, link.mat_a) ? link.mat_a : link.mat_b, 1.0);
  }
  kind.reach = reach_between(reach, network, mats_a, mats_b);
  kind.reach.begins = begins;
  kind.reach.rests_differ = rests_differ;
  return kind;
}

Kind kind_of(const NetworkDescription& network, std::uint32_t index, const Reach& reach) {
  const engine::SetLiaison& set = network.sets[index];
  const SetStart start = set_start_of(network, set, reach);
  Kind kind{
      {LiaisonKind::kSet, index}, network.state_machines[set.state_machine], start.rest_length};
  kind.possible = possible_elongations(
      start.rest_length, network.dimension > 1 && !engine::acts_on_surfaces(network, set));
  kind.reach = start.reach;
  kind.counts.assign(network.mats.size(), 0.0);
  const bool is_within = set.set_q.empty();
  const auto& others = is_within ? set.set_p : set.set_q;
  const bool p_moves =
      std::ranges::any_of(set.set_p, [&](std::uint32_t mat) { return is_free_mass(network, mat); });
  const double pairs = static_cast<double>(p_moves ? others.size() : set.set_p.size());
  for (const std::uint32_t mat : p_moves ? set.set_p : others) {
    if (is_free_mass(network, mat)) kind.add_at(mat, is_within ? 0.5 * (pairs - 1.0) : pairs);
  }
  return kind;
}

/// What a bend asks for, as a link asks for it.
engine::Quantity of_link(engine::Quantity quantity) noexcept {
  using engine::Quantity;
  switch (quantity) {
    case Quantity::kAngle:
      return Quantity::kDistance;
    case Quantity::kBend:
      return Quantity::kElongation;
    case Quantity::kAngularSpeed:
      return Quantity::kSpeed;
    case Quantity::kMoment:
      return Quantity::kForce;
    case Quantity::kRestAngle:
      return Quantity::kRestLength;
    default:
      return quantity;
  }
}

/// The states of a bend as those of a link whose distance is the angle. A state with a rest angle of its own gives it
/// to what enters it.
engine::StateMachine as_of_link(engine::StateMachine machine) {
  const auto translate = [](engine::Program& program) {
    for (engine::Instruction& instruction : program.code)
      instruction.quantity = of_link(instruction.quantity);
  };
  for (engine::Transition& exit : machine.exits) {
    translate(exit.when);
    translate(exit.rest_length);
    const std::optional<double>& angle = machine.states[exit.target].rest_angle;
    if (exit.rest != engine::RestRule::kKeep || !angle) continue;
    exit.rest = engine::RestRule::kExpression;
    exit.rest_length.code = {{.operation = engine::Operation::kConstant, .constant = *angle}};
  }
  return machine;
}

/// A bend, with angles for lengths. Its moment counts as that of small bends.
Kind kind_of_bend(const NetworkDescription& network, std::uint32_t index, const Reach& reach) {
  constexpr double kTurn = std::numbers::pi;
  const engine::Bend& bend = network.bends[index];
  Kind kind{{LiaisonKind::kBend, index},
            as_of_link(network.state_machines[bend.state_machine]),
            bend.rest_angle};
  engine::BendSides sides;
  sides.u = network.mats[bend.mat_b].position - network.mats[bend.mat_a].position;
  sides.v = network.mats[bend.mat_c].position - network.mats[bend.mat_b].position;
  const double angle = engine::angle_of(bend, network.dimension, sides).angle;
  const double start = engine::angle_beyond(bend.rest_angle, angle, network.dimension);
  if (network.dimension > 1) kind.possible = {network.dimension > 2 ? 0.0 : -kTurn, kTurn};
  const std::vector<std::uint32_t> mats{bend.mat_a, bend.mat_b, bend.mat_c};
  kind.reach = reach_between(reach, network, mats, mats);
  kind.reach.mass_a = kind.reach.mass_b = {};
  kind.reach.force = kind.reach.driven = 0.0;
  const double of_a = 1.0 / bend.length_ab;  // by how much the angle turns for each metre of a
  const double of_c = 1.0 / bend.length_bc;
  const auto inverse_mass = [&](std::uint32_t mat) {
    return is_free_mass(network, mat) ? 1.0 / network.mats[mat].mass : 0.0;
  };
  kind.reach.inverse_mass = of_a * of_a * inverse_mass(bend.mat_a) +
                            (of_a + of_c) * (of_a + of_c) * inverse_mass(bend.mat_b) +
                            of_c * of_c * inverse_mass(bend.mat_c);
  kind.reach.speed = 2.0 * (of_a + of_c) * reach.speed;
  kind.reach.elongation = std::max(std::abs(start), 1.0);
  kind.reach.begins = {start, start};
  kind.counts.assign(network.mats.size(), 0.0);
  const auto mass =
      std::ranges::find_if(mats, [&](std::uint32_t mat) { return is_free_mass(network, mat); });
  kind.add_at(mass == mats.end() ? bend.mat_b : *mass, 1.0);
  return kind;
}

}  // namespace

Switching switching_of(const NetworkDescription& network, const Reach& reach) {
  std::vector<Kind> kinds;
  for (const auto& [key, links] : links_by_kind(network))
    kinds.push_back(kind_of(network, links, reach));
  for (std::uint32_t s = 0; s < network.sets.size(); ++s) {
    if (!network.state_machines[network.sets[s].state_machine].exits.empty())
      kinds.push_back(kind_of(network, s, reach));
  }
  std::map<std::pair<std::uint32_t, float>, Kind> bends;
  for (std::uint32_t b = 0; b < network.bends.size(); ++b) {
    const engine::Bend& bend = network.bends[b];
    if (!bend.has_states() || network.state_machines[bend.state_machine].exits.empty()) continue;
    const std::pair key{bend.state_machine, static_cast<float>(bend.rest_angle)};
    const auto [known, is_new] = bends.try_emplace(key, kind_of_bend(network, b, reach));
    if (!is_new) known->second.join(kind_of_bend(network, b, reach));
  }
  for (auto& [key, kind] : bends) kinds.push_back(std::move(kind));
  Switching switching;
  std::vector<double> each(kinds.size(), 0.0);
  const auto find = [&](double more) {
    double all = 0.0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      each[k] = kinds[k].brought(more);
      if (std::isinf(each[k]) && !switching.endless) switching.endless = kinds[k].first;
      if (std::isinf(each[k])) each[k] = 0.0;
      all += kinds[k].count * each[k];
    }
    return all;
  };
  constexpr int kRounds = 20;
  constexpr double kMore = 1.05;
  double all = find(0.0);
  for (int round = 0; all > 0.0; ++round) {
    const std::vector<double> before = each;
    const double known = kMore * all;
    all = find(known);
    double sources = 0.0;
    for (std::size_t k = 0; k < kinds.size(); ++k) sources += each[k] > 0.0 ? kinds[k].count : 0.0;
    if (sources <= 1.0) {  // it has found what it brought in itself, and wakes no other
      each = before;
      break;
    }
    if (all <= known) break;
    if (round < kRounds) continue;
    std::size_t most = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k)
      if (kinds[k].count * each[k] > kinds[most].count * each[most]) most = k;
    switching.endless = kinds[most].first;
    break;
  }
  switching.at_mats.assign(network.mats.size(), 0.0);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    for (std::size_t mat = 0; mat < network.mats.size(); ++mat)
      switching.at_mats[mat] += kinds[k].counts[mat] * each[k];
  }
  for (const double part : switching.at_mats) switching.all += part;
  return switching;
}

}  // namespace cordis::plan
