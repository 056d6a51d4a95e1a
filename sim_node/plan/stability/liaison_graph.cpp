// sim_node/plan/stability/liaison_graph.cpp
#include "sim_node/plan/stability/liaison_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "sim_node/plan/stability/bend_slope.h"
#include "sim_node/plan/stability/force_slopes.h"
#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/parameter_bounds.h"
#include "sim_node/plan/stability/partner_bound.h"
#include "sim_node/plan/stability/set_slope.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/stability/touch_sum.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

/// The largest slope of Lennard-Jones from its touch distance to its cutoff, along or across [N/m].
double slope_beyond(const engine::LennardJones& law, double touch, double range) {
  constexpr int kSamples = 200;
  const double end = law.cutoff > 0.0 ? std::min(law.cutoff, range) : range;
  double largest = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const double distance = touch + (end - touch) * i / kSamples;
    largest = std::max(largest, elastic_tension(law, {distance, distance}) / distance);
  }
  return largest;
}

constexpr const char* kFed = "its parameter changes and does work without an end";
constexpr const char* kFallsWithoutEnd = "it brings in energy without an end";
constexpr const char* kSwitches = "nothing bounds the energy that its changes of state bring in";
constexpr const char* kFallsOnItself =
    "it brings in energy without an end, and a law without a largest slope may take it";
constexpr const char* kStartsTooStrong =
    "its start force is above stiffness times distance, and turns without a limit where its ends "
    "meet";

/// A start force of up to K times the distance is that of a spring without a rest length.
/// @param softest  the least K of the element [N/m]
bool turns_without_limit(const NetworkDescription& network, const engine::MaxwellLink& link,
                         double softest) {
  if (network.dimension == 1) return false;
  const engine::Vec3 along = network.mats[link.mat_b].position - network.mats[link.mat_a].position;
  return link.start_force > softest * along.norm();
}

/// True if the value of a law has no bound because of one of its variables, though all others are at most 1.
bool is_unbounded_by(const engine::Program& program, std::uint32_t variable,
                     const std::vector<Interval>& ranges) {
  std::vector<Interval> narrow = ranges;
  for (Interval& range : narrow)
    range = {std::clamp(-1.0, range.low, range.high), std::clamp(1.0, range.low, range.high)};
  narrow[variable] = ranges[variable];
  LinkBox box;
  box.distance = box.mass_a = box.mass_b = {0.0, 1.0};
  box.speed = {-1.0, 1.0};
  box.variables = &narrow;
  const Interval value = values_of(program, box);
  return !std::isfinite(value.low) || !std::isfinite(value.high);
}

/// What the laws of a state machine ask for and nothing bounds; where each alone is harmless, all of it.
std::vector<std::uint32_t> unbounded_variables(const engine::StateMachine& state_machine,
                                               const std::vector<Interval>& ranges) {
  std::vector<std::uint32_t> asked;
  std::vector<std::uint32_t> unbounded;
  const auto read = [&](const engine::Program& program) {
    for (const engine::Instruction& instruction : program.code) {
      const std::uint32_t variable = instruction.slot;
      if (instruction.operation != engine::Operation::kVariable) continue;
      if (std::ranges::find(asked, variable) != asked.end()) continue;
      asked.push_back(variable);
      if (is_unbounded_by(program, variable, ranges)) unbounded.push_back(variable);
    }
  };
  for (const engine::LinkState& state : state_machine.states) {
    for (const engine::Law* const law : {&state.elasticity, &state.dissipation}) {
      if (const auto* expression = std::get_if<engine::Expression>(law)) read(expression->program);
    }
    for (const engine::ParameterFormula& each : state.formulas) read(each.formula);
  }
  return unbounded.empty() ? asked : unbounded;
}

std::uint32_t state_machine_of(const NetworkDescription& network, LiaisonId liaison) {
  switch (liaison.kind) {
    case LiaisonKind::kSet:
      return network.sets[liaison.index].state_machine;
    case LiaisonKind::kMaxwellLink:
      return network.maxwell_links[liaison.index].state_machine;
    case LiaisonKind::kBend:
      return network.bends[liaison.index].state_machine;
    default:
      return network.state_links[liaison.index].state_machine;
  }
}

/// True if a law of it does.
bool follows_variables(const NetworkDescription& network, LiaisonId liaison) {
  if (liaison.kind == LiaisonKind::kLink) return false;
  const std::uint32_t machine = state_machine_of(network, liaison);
  return machine < network.state_machines.size() &&
         laws_ask_for_variable(network.state_machines[machine]);
}

std::vector<std::uint32_t> unbounded_variables(const NetworkDescription& network, LiaisonId liaison,
                                               const Reach& reach) {
  return unbounded_variables(network.state_machines[state_machine_of(network, liaison)],
                             *reach.variables);
}

/// Precondition: the liaison has a state machine, or nothing is uncertain of it.
void note(const NetworkDescription& network, const Slope& slope, LiaisonId liaison,
          LiaisonGraph& graph) {
  graph.bounded = graph.bounded && slope.bounded;
  if (!slope.bounded && !(slope.law_is_bounded && slope.passing > 0.0)) {
    graph.laws_are_bounded = false;
    if (!graph.without_largest_slope) graph.without_largest_slope = liaison;
  }
  if (slope.passing > graph.passing) {
    graph.passing = slope.passing;
    graph.passable = liaison;
  }
  if (slope.uncertainty == nullptr || graph.uncertainty) return;
  graph.uncertainty = {liaison, slope.uncertainty};
  if (is_of_variables(slope.uncertainty))
    graph.uncertainty->variables = unbounded_variables(network, liaison, graph.reach);
}

/// Precondition: the set has no largest slope.
void record_share(std::uint32_t set, const Reach& of_scene, const SetStart& start,
                  LiaisonGraph& graph) {
  constexpr double kWhole = 0.99;
  if (!start.are_balls) return;
  const PairShare share{set, start.reach.energy, std::max(of_scene.energy, of_scene.brought)};
  if (share.energy >= kWhole * share.whole) return;
  const auto& least = graph.pair_share;
  if (!least || share.energy * least->whole < least->energy * share.whole) graph.pair_share = share;
}

/// One side of a set: its touching pairs, and those beyond.
void add_side(const NetworkDescription& network, std::uint32_t index, const Slope& slope,
              const PartnerBounds& bounds, bool of_p, LiaisonGraph& graph) {
  const engine::SetLiaison& set = network.sets[index];
  const auto first = static_cast<std::ptrdiff_t>(of_p ? 0 : set.set_p.size());
  const auto& members = of_p ? set.set_p : set.set_q;
  const auto last = first + static_cast<std::ptrdiff_t>(members.size());
  ContactBound side;
  side.members = members;
  side.others = of_p && !set.set_q.empty() ? set.set_q : set.set_p;
  side.neighbours.assign(bounds.needed.begin() + first, bounds.needed.begin() + last);
  side.possible.assign(bounds.possible.begin() + first, bounds.possible.begin() + last);
  side.apart = apart_of(network, set, side);
  side.stiffness = slope.stiffness;
  side.viscosity = slope.viscosity;
  side.set = index;
  side.bounded = slope.bounded;
  side.variation = slope.variation;
  side.fall = slope.fall;
  side.fall_anywhere = slope.fall_anywhere;
  side.damping_ratio = slope.damping_ratio;
  side.touch_damping = slope.touch_damping;
  side.at_start = bounds.at_start;
  graph.contacts.push_back(side);

  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const double touch = engine::touch_distance(state_machine);
  if (touch >= set.range || engine::acts_on_surfaces(network, set)) return;
  const auto& law = std::get<engine::LennardJones>(state_machine.states.front().elasticity);
  side.stiffness = slope_beyond(law, touch, set.range);
  side.counted = false;
  for (double& most : side.possible) {
    most = std::min(most, packing_bound(network.dimension, set.range, law.diameter));
  }
  side.neighbours = side.possible;
  graph.contacts.push_back(std::move(side));
}

/// A pair of a set at a distance, for each two of the lightest and heaviest masses it may have.
std::array<engine::LawPoint, 4> points_at(double distance, double rest_length, const Reach& reach) {
  const auto point = [&](double mass_a, double mass_b) {
    return engine::LawPoint{distance, distance - rest_length, 0.0, mass_a, mass_b};
  };
  return {point(reach.mass_a.low, reach.mass_b.low), point(reach.mass_a.low, reach.mass_b.high),
          point(reach.mass_a.high, reach.mass_b.low), point(reach.mass_a.high, reach.mass_b.high)};
}

constexpr double kJump = 0.1;
constexpr double kJumpOfSlow = 1e-3;

/// True if a pair in the state of its start still pulls or pushes where it crosses its range, with
/// more than a share of what the largest slope of that state would over the whole range. What is slow comes to
/// surfaces, and to what pushes it away, over and over, and is thrown off each time as if it had come fast.
bool jumps_at_range(const engine::StateMachine& state_machine, double rest_length, double range,
                    int dimension, const Reach& reach, bool on_surfaces) {
  const auto is_jump = [&](double tension, double slope) {
    const double share = on_surfaces || tension < 0.0 ? kJumpOfSlow : kJump;
    return std::abs(tension) > share * slope * range;
  };
  constexpr double kJustWithin = 1.0 - 1e-9;
  const engine::StateMachine start = start_state_alone(state_machine);
  const engine::LinkState& state = start.states[0];
  const double slope = largest_slope(start, rest_length, dimension, reach).stiffness;
  if (asks_for_variable(state.elasticity)) {
    const Interval tension = tension_at(state, kJustWithin * range, rest_length, reach);
    return is_jump(tension.low, slope) || is_jump(tension.high, slope);
  }
  const auto points = points_at(kJustWithin * range, rest_length, reach);
  return std::any_of(points.begin(), points.end(), [&](const engine::LawPoint& point) {
    const double tension =
        std::clamp(state.stiffness * point.elongation + elastic_tension(state.elasticity, point),
                   state.pushes ? -state.force_limit : 0.0, state.pulls ? state.force_limit : 0.0);
    return is_jump(tension, slope);
  });
}

/// True if the energy of the scene carries no pair of a set that begins within its range beyond it.
bool is_confined(const engine::StateMachine& state_machine, double rest_length, double range,
                 const Reach& reach) {
  if (is_fed(state_machine)) return false;
  const auto points = points_at(range, rest_length, reach);
  return !reach.held &&
         std::all_of(points.begin(), points.end(), [&](const engine::LawPoint& point) {
           return stored_in(state_machine, point) > energy_at(reach) + work_of_forces(reach, range);
         });
}

/// The least rest length of a pair that has one [m]; 0: none has.
double shortest_rest(const NetworkDescription& network, const engine::SetLiaison& set) {
  if (set.rest_length >= 0.0) return set.rest_length;
  const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
  const double both = smallest_radius(network, set.set_p) + smallest_radius(network, others);
  if (both > 0.0) return both;
  double least = std::numeric_limits<double>::infinity();
  for (const auto* half : {&set.set_p, &set.set_q}) {
    for (const std::uint32_t mat : *half) {
      const double radius = radius_of(network, mat);
      if (radius > 0.0) least = std::min(least, radius);
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

/// What brings a pair of a set so far inwards that it turns about [J].
double energy_of_turning(const NetworkDescription& network, const engine::SetLiaison& set,
                         const Reach& reach) {
  const bool on_surfaces = engine::acts_on_surfaces(network, set);
  if (on_surfaces && network.dimension == 1) return std::numeric_limits<double>::infinity();
  const WayInwards way{.rest_length = shortest_rest(network, set),
                       .farthest = set.range,
                       .turns_at = on_surfaces ? flips_at(network, set) : 0.0,
                       .passes = network.dimension == 1};
  return energy_of_turning(network.state_machines[set.state_machine], way, reach);
}

/// @return what all of its pairs store at the start, and what each member may gain in one of them [J]
double add_set(const NetworkDescription& network, std::uint32_t index, const Reach& reach,
               LiaisonGraph& graph) {
  const engine::SetLiaison& set = network.sets[index];
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const bool on_surfaces = engine::acts_on_surfaces(network, set);
  const SetStart start = set_start_of(network, set, reach);
  Slope slope = largest_slope_of(network, set, start);
  if (!slope.bounded && !std::isfinite(start.fall) && slope.uncertainty == nullptr)
    slope.uncertainty = kFallsOnItself;
  if (network.dimension == 1 && !on_surfaces && slope.uncertainty == nullptr &&
      pull_jumps_where_pairs_pass(state_machine, start.rest_length, slope, start.reach))
    slope.uncertainty = "it pulls where its ends pass each other, and jumps there";
  note(network, slope, {LiaisonKind::kSet, index}, graph);
  if (!slope.bounded) record_share(index, reach, start, graph);
  if (!graph.uncertainty &&
      !(start.all_begin_within &&
        is_confined(state_machine, start.rest_length, set.range, start.reach)) &&
      jumps_at_range(state_machine, start.rest_length, set.range,
                     on_surfaces ? 1 : network.dimension, start.reach, on_surfaces))
    graph.uncertainty = {{LiaisonKind::kSet, index}, "its force jumps at its range"};
  const PartnerBounds bounds = partner_bounds(network, set);
  add_side(network, index, slope, bounds, /*of_p=*/true, graph);
  if (!set.set_q.empty()) add_side(network, index, slope, bounds, /*of_p=*/false, graph);
  if (!start.is_known) return std::numeric_limits<double>::infinity();
  if (!std::isfinite(start.fall)) return start.stored;
  return start.stored +
         start.fall * static_cast<double>(std::max(set.set_p.size(), set.set_q.size()));
}

/// Adds the sets to what turns about, and to the energy there is for it what they store.
/// @param stored  by all sets [J]
Turning turning_with_sets(const NetworkDescription& network, Reach reach, double stored) {
  if (!reach.counts_sets) reach.brought += stored;
  Turning turning = turning_of(network, reach);
  for (std::uint32_t index = 0; index < network.sets.size(); ++index) {
    const engine::SetLiaison& set = network.sets[index];
    const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
    const Reach here = reach_between(reach, network, set.set_p, others);
    add_turning({LiaisonKind::kSet, index}, energy_of_turning(network, set, here), here, turning);
  }
  return turning;
}

}  // namespace

double largest_of_others(const ContactBound& contact, const std::vector<double>& values) {
  double most = 0.0;
  for (const std::uint32_t mat : contact.others) most = std::max(most, values[mat]);
  return most;
}

namespace {

/// A bend as a link along each side: |v / l - R u / k|^2 is at most (1 / k + 1 / l) (|u|^2 / k + |v|^2 / l), as
/// equal as can be where it bends the most.
void add_bend(const NetworkDescription& network, std::uint32_t index, bool knows_all_energy,
              SlopesOfBends& slopes, LiaisonGraph& graph) {
  const engine::Bend& bend = network.bends[index];
  const LiaisonId id{LiaisonKind::kBend, index};
  LinearBounds bounds = linear_bounds(network, bend, graph.reach);
  Slope slope;
  if (!std::isfinite(bounds.stiffness.high) || !std::isfinite(bounds.viscosity.high)) {
    slope.uncertainty = kUnboundedVariable;
    if (!std::isfinite(bounds.stiffness.high)) bounds.stiffness = {};
    if (!std::isfinite(bounds.viscosity.high)) bounds.viscosity = {};
  } else if (bounds.stiffness.low < 0.0) {
    slope.uncertainty = kMayDriveApart;
  } else if (bounds.viscosity.low < 0.0) {
    slope.uncertainty = kMayDriveMotion;
  }
  const bool has_laws =
      bend.has_states() && has_laws_of_bends(network.state_machines[bend.state_machine]);
  const Slope of_laws = has_laws ? slopes.slope_of(bend) : Slope{};
  if (slope.uncertainty == nullptr) slope.uncertainty = of_laws.uncertainty;
  slope.bounded = of_laws.bounded;
  note(network, slope, id, graph);
  // A change of state is no change of a slope, but that of a parameter is one.
  const bool varies =
      bend.has_states() && laws_ask_for_variable(network.state_machines[bend.state_machine]);
  const double variation =
      (varies ? bounds.stiffness.high - bounds.stiffness.low : 0.0) + of_laws.variation;
  const double stiffness = std::max(bounds.stiffness.high, 0.0) + of_laws.stiffness;
  const double viscosity = std::max(bounds.viscosity.high, 0.0) + of_laws.viscosity;
  const double fall = knows_all_energy ? of_laws.fall : of_laws.fall_anywhere;
  const double both = 1.0 / bend.length_ab + 1.0 / bend.length_bc;
  const double at_ab = both / bend.length_ab;
  const double at_bc = both / bend.length_bc;
  const double ratio =
      has_laws ? damping_ratio(viscosity, std::max(bounds.stiffness.low, 0.0) +
                                              std::max(of_laws.stiffness - of_laws.variation, 0.0))
               : max_damping_ratio(network, bend, graph.reach);
  const auto add_side = [&](std::uint32_t mat_a, std::uint32_t mat_b, double share) {
    graph.edges.push_back({mat_a, mat_b, share * stiffness, share * viscosity, id, slope.bounded,
                           share * variation, ratio});
    graph.edges.back().fall = share * fall;
    graph.edges.back().fall_anywhere = share * of_laws.fall_anywhere;
  };
  add_side(bend.mat_a, bend.mat_b, at_ab);
  add_side(bend.mat_b, bend.mat_c, at_bc);
}

void add_maxwell_link(const NetworkDescription& network, std::uint32_t index, LiaisonGraph& graph) {
  const engine::MaxwellLink& link = network.maxwell_links[index];
  const LiaisonId id{LiaisonKind::kMaxwellLink, index};
  LinearBounds bounds = linear_bounds(network, link, graph.reach);
  Slope slope;
  if (!std::isfinite(bounds.stiffness.high)) {
    slope.uncertainty = kUnboundedVariable;
    bounds.stiffness = {};
  }
  note(network, slope, id, graph);
  if (turns_without_limit(network, link, bounds.stiffness.low) && !graph.uncertainty)
    graph.uncertainty = {id, kStartsTooStrong};
  engine::MaxwellLink largest = link;
  largest.stiffness = bounds.stiffness.high;
  largest.viscosity = bounds.viscosity.high;
  graph.maxwell_links.push_back(largest);
  graph.edges.push_back({link.mat_a, link.mat_b, largest.stiffness, 0.0, id, true,
                         bounds.stiffness.high - bounds.stiffness.low});
}

}  // namespace

void LiaisonGraph::set_step(double step) {
  for (Edge& edge : edges) {
    if (edge.liaison.kind != LiaisonKind::kMaxwellLink) continue;
    const engine::MaxwellLink& link = maxwell_links[edge.liaison.index];
    // Stepped with the mean of the rates at two steps: the least is that of one K at its least.
    const double least = link.stiffness - edge.variation;
    const double turn = 0.25 * (least + link.stiffness) * step / link.viscosity;
    edge.stiffness = turn > 0.0 ? link.stiffness * std::tanh(turn) / turn : link.stiffness;
  }
}

namespace {

bool has_expression(const engine::StateMachine& machine) {
  return std::ranges::any_of(machine.states, [](const engine::LinkState& state) {
    return std::holds_alternative<engine::Expression>(state.elasticity) ||
           std::holds_alternative<engine::Expression>(state.dissipation);
  });
}

/// The largest slopes of links with states: found once for all that are alike but for rounding. Where
/// many with an expression differ, as by a rest length of their own, they share the bisections, and
/// bounds are less near.
class SlopesOfLinks {
 public:
  SlopesOfLinks(const NetworkDescription& network, const Reach& reach)
      : network_(network), reach_(reach), bisections_(reach.bisections) {
    std::vector<bool> may_bisect;
    for (const engine::StateMachine& machine : network.state_machines)
      may_bisect.push_back(has_expression(machine));
    std::set<Key> different;
    for (const engine::StateLink& link : network.state_links)
      if (may_bisect[link.state_machine]) different.insert(key_of(link, reach_at_ends(link)));
    constexpr std::size_t kThatTakeAll = 64;
    constexpr std::size_t kFewest = 16;
    const auto most = static_cast<std::size_t>(reach.bisections);
    if (different.size() > kThatTakeAll)
      bisections_ = static_cast<int>(std::max(kFewest, most * kThatTakeAll / different.size()));
  }

  const Slope& slope_of(const engine::StateLink& link) {
    Reach here = reach_at_ends(link);
    here.bisections = bisections_;
    const Key key = key_of(link, here);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const engine::StateMachine& machine = network_.state_machines[link.state_machine];
    here.begins = begins_at(link);
    return known_.emplace(key, largest_slope(machine, link.rest_length, network_.dimension, here))
        .first->second;
  }

 private:
  using Key = std::tuple<std::uint32_t, float, double, double, bool, float>;

  /// Where it begins, as far as its changes of state ask for it.
  Interval begins_at(const engine::StateLink& link) const {
    if (network_.state_machines[link.state_machine].is_stateless()) return {};
    const double elongation = start_point(network_, link).elongation;
    return {elongation, elongation};
  }
  Reach reach_at_ends(const engine::StateLink& link) const {
    return reach_of_link(reach_, network_, link.mat_a, link.mat_b);
  }
  Key key_of(const engine::StateLink& link, const Reach& here) const {
    return {link.state_machine, static_cast<float>(link.rest_length),
            here.mass_a.low,    here.mass_b.low,
            here.held,          static_cast<float>(begins_at(link).low)};
  }

  const NetworkDescription& network_;
  const Reach& reach_;
  int bisections_;  // of each
  std::map<Key, Slope> known_;
};

}  // namespace

namespace {

constexpr const char* kBringsEnergy =
    "nothing bounds the energy that it brings to a law without a largest slope";

constexpr const char* kPresses =
    "nothing bounds the energy with which it presses balls against a surface that they may pass";

/// True if a set touches a surface whose normal flips.
bool may_pass_a_surface(const NetworkDescription& network) {
  return std::ranges::any_of(network.sets, [&](const engine::SetLiaison& set) {
    return engine::acts_on_surfaces(network, set) && std::isfinite(flips_at(network, set));
  });
}

/// Adds the driven forces that depend on more than time. Precondition: all else is in the graph.
void add_forces(const NetworkDescription& network, LiaisonGraph& graph) {
  std::vector<std::optional<ForceSlopes>> known(network.time_functions.size());
  SlopesOfForces slopes_of_forces(network);
  const bool may_pass = !network.drives.empty() && may_pass_a_surface(network);
  for (std::uint32_t d = 0; d < network.drives.size(); ++d) {
    const engine::Drive& drive = network.drives[d];
    if (!drive.is_force || is_of_time(network.time_functions[drive.function])) continue;
    std::optional<ForceSlopes>& slopes = known[drive.function];
    if (!slopes) slopes = slopes_of_forces.of(network.time_functions[drive.function]);
    const LiaisonId liaison{LiaisonKind::kForce, d};
    if (!graph.uncertainty && !slopes->uncertainty.empty())
      graph.uncertainty = {liaison, slopes->uncertainty, slopes->variables};
    graph.fed_by_forces = graph.fed_by_forces || slopes->brings_energy;
    const bool may_press = may_pass || !graph.bounded;
    if (!graph.uncertainty && !graph.laws_are_bounded && slopes->brings_energy)
      graph.uncertainty = {liaison, kBringsEnergy, {}, graph.takes_energy()};
    if (!graph.uncertainty && slopes->brings_energy && may_press)
      graph.uncertainty = {liaison, kPresses, {}, graph.passable};
    if (slopes->stiffness > 0.0 || slopes->viscosity > 0.0) {
      graph.forces.push_back({drive.mat, slopes->stiffness, slopes->viscosity, slopes->variation,
                              liaison, slopes->variation, slopes->variation});
    }
  }
}

}  // namespace

namespace {

/// The first link with states or set of an unbounded state machine.
std::optional<LiaisonId> first_unbounded(const NetworkDescription& network,
                                         const std::vector<bool>& is_unbounded) {
  for (std::uint32_t s = 0; s < network.sets.size(); ++s)
    if (is_unbounded[network.sets[s].state_machine]) return LiaisonId{LiaisonKind::kSet, s};
  for (std::uint32_t l = 0; l < network.state_links.size(); ++l)
    if (is_unbounded[network.state_links[l].state_machine])
      return LiaisonId{LiaisonKind::kStateLink, l};
  return {};
}

LiaisonGraph graph_of(const NetworkDescription& network, double reach_factor);

}  // namespace

LiaisonGraph liaison_graph(const NetworkDescription& network, double reach_factor) {
  if (!has_formulas(network)) return graph_of(network, reach_factor);
  const LargestParameters largest = largest_parameters(network);
  LiaisonGraph graph = graph_of(largest.network, reach_factor);
  const std::optional<LiaisonId> unbounded = first_unbounded(network, largest.is_unbounded);
  if (unbounded && !graph.uncertainty) {
    graph.uncertainty = {*unbounded, kUnboundedVariable,
                         unbounded_variables(network, *unbounded, graph.reach)};
  }
  return graph;
}

namespace {

LiaisonGraph graph_of(const NetworkDescription& network, double reach_factor) {
  LiaisonGraph graph;
  for (const engine::Mat& mat : network.mats) {
    const bool is_mass = mat.kind == engine::MatKind::kMass;
    graph.inverse_mass.push_back(is_mass ? 1.0 / mat.mass : 0.0);
    graph.medium_viscosity.push_back(is_mass ? network.medium_viscosity_on(mat) : 0.0);
  }
  graph.edges.reserve(network.links.size() + network.state_links.size() +
                      network.maxwell_links.size() + 2 * network.bends.size());
  std::uint32_t index = 0;
  for (const engine::Link& link : network.links) {
    Edge edge{link.mat_a, link.mat_b, link.stiffness, link.viscosity, {LiaisonKind::kLink, index}};
    edge.damping_ratio = damping_ratio(link.viscosity, link.stiffness);
    graph.edges.push_back(edge);
    ++index;
  }
  graph.reach = reach_of(network, reach_factor);
  const Reach& reach = graph.reach;
  index = 0;
  SlopesOfLinks slopes(network, reach);
  const bool knows_all_energy =
      (network.sets.empty() || reach.counts_sets) && !reach.switched.has_value();
  for (const engine::StateLink& link : network.state_links) {
    Slope slope = slopes.slope_of(link);
    const engine::StateMachine& machine = network.state_machines[link.state_machine];
    const engine::LawPoint start = start_point(network, link);
    slope.stiffness =
        std::max(slope.stiffness, stiffness_across_at(machine, network.dimension, start));
    if (network.dimension == 1 && slope.uncertainty == nullptr)
      slope.uncertainty = jumps_from_behind(machine, start);
    if (slope.uncertainty == nullptr && any_moves(network, link.mat_a, link.mat_b))
      slope.uncertainty = starts_at_one_point(machine, start);
    note(network, slope, {LiaisonKind::kStateLink, index}, graph);
    graph.edges.push_back({link.mat_a,
                           link.mat_b,
                           slope.stiffness,
                           slope.viscosity,
                           {LiaisonKind::kStateLink, index++},
                           slope.bounded,
                           slope.variation,
                           slope.damping_ratio});
    graph.edges.back().fall = knows_all_energy ? slope.fall : slope.fall_anywhere;
    graph.edges.back().fall_anywhere = slope.fall_anywhere;
    graph.edges.back().touch_damping = slope.touch_damping;
  }
  for (index = 0; index < network.maxwell_links.size(); ++index)
    add_maxwell_link(network, index, graph);
  SlopesOfBends slopes_of_bends(network, reach);
  for (index = 0; index < network.bends.size(); ++index)
    add_bend(network, index, knows_all_energy, slopes_of_bends, graph);
  double stored = 0.0;
  for (index = 0; index < network.sets.size(); ++index)
    stored += add_set(network, index, reach, graph);
  for (Edge& edge : graph.edges) edge.follows = follows_variables(network, edge.liaison);
  for (ContactBound& contact : graph.contacts)
    contact.follows = follows_variables(network, {LiaisonKind::kSet, contact.set});
  graph.turning = turning_with_sets(network, reach, stored);
  add_forces(network, graph);
  const std::string where = graph.laws_are_bounded
                                ? ", and with enough energy a ball passes a surface"
                                : ", and a law without a largest slope may take it";
  if (reach.endless && !graph.bounded && !graph.uncertainty) {
    graph.uncertainty = {{LiaisonKind::kStateLink, *reach.endless},
                         kFallsWithoutEnd + where,
                         {},
                         graph.takes_energy()};
  }
  if (reach.switched && reach.counts_sets && !graph.bounded && !graph.uncertainty)
    graph.uncertainty = {*reach.switched, kSwitches + where, {}, graph.takes_energy()};
  if (reach.fed && !graph.bounded && !graph.uncertainty) {
    graph.uncertainty = {*reach.fed, kFed + where, unbounded_variables(network, *reach.fed, reach),
                         graph.takes_energy()};
  }
  return graph;
}

}  // namespace

}  // namespace cordis::plan
