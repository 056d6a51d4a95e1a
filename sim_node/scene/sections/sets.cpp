// sim_node/scene/sections/sets.cpp
#include "sim_node/scene/sections/sets.h"

#include <algorithm>
#include <utility>

#include "node/config/number.h"
#include "sim_node/engine/pairs/start_pair_count.h"
#include "sim_node/scene/liaisons/law.h"

namespace cordis::scene {

namespace {

using config::Value;
using engine::LawArgument;

bool depends_on_rest(const engine::Program& program) {
  return std::any_of(program.code.begin(), program.code.end(), [](const auto& instruction) {
    return instruction.operation == engine::Operation::kQuantity &&
           (instruction.quantity == engine::Quantity::kElongation ||
            instruction.quantity == engine::Quantity::kRestLength);
  });
}

/// True if anything in a state machine asks for the rest length of a pair.
bool depends_on_rest(const engine::StateMachine& state_machine) {
  const auto asks = [](const engine::LinkState& state) {
    const LawArgument elastic = argument_of(state.elasticity);
    return state.stiffness > 0.0 || elastic == LawArgument::kElongation ||
           elastic == LawArgument::kAny || argument_of(state.dissipation) == LawArgument::kAny;
  };
  return std::any_of(state_machine.states.begin(), state_machine.states.end(), asks) ||
         std::any_of(state_machine.exits.begin(), state_machine.exits.end(),
                     [](const engine::Transition& exit) { return depends_on_rest(exit.when); });
}

/// The distance from which on a state machine does nothing by itself [m]; 0 when there is none.
double reach_of_all(const engine::StateMachine& state_machine) {
  double reach = 0.0;
  for (const engine::LinkState& state : state_machine.states) {
    const double own = range_of(state.elasticity);
    if (state.stiffness > 0.0 || own <= 0.0) return 0.0;
    reach = std::max(reach, own);
  }
  return reach;
}

bool has_lennard_jones(const engine::StateMachine& state_machine) {
  return std::any_of(state_machine.states.begin(), state_machine.states.end(),
                     [](const engine::LinkState& state) {
                       return std::holds_alternative<engine::LennardJones>(state.elasticity);
                     });
}

/// How far apart two MATs may be to be joined [m]; 0 when nothing limits it.
double range_of(const LinkLaw& law, const engine::StateMachine& state_machine, double rest) {
  if (law.reach.rule == Reach::Rule::kLength) return law.reach.length;
  return law.reach.rule == Reach::Rule::kRest ? rest : reach_of_all(state_machine);
}

constexpr const char* kSurfaceInSet = "surfaces are a set of their own";
constexpr const char* kWriteTwoSets = "write between_sets: [matter, surfaces]";

/// Puts the set of surfaces first. @return false when there are other MATs in it, which is a problem
bool take_surfaces(Assembly& assembly, config::MappingReader& reader,
                   std::vector<std::vector<std::uint32_t>>& sets) {
  const auto is_whole = [&](const std::vector<std::uint32_t>& set) {
    return assembly.count_surfaces(set) == set.size();
  };
  if (assembly.count_surfaces(sets[0]) + assembly.count_surfaces(sets[1]) == 0) return true;
  if (is_whole(sets[0]) && is_whole(sets[1])) {
    reader.error_at("between_sets", "both sets are surfaces");
    return false;
  }
  if (!is_whole(sets[0])) std::swap(sets[0], sets[1]);
  if (is_whole(sets[0]) && assembly.count_surfaces(sets[1]) == 0) return true;
  reader.error_at("between_sets", kSurfaceInSet, kWriteTwoSets);
  return false;
}

constexpr const char* kOneOfThem =
    "a link is within a set, between two sets or between ends: one of them";

/// The two largest radii of two sets, or of two balls of one set, together.
double largest_radii(const std::vector<double>& p, const std::vector<double>& q) {
  const auto largest = [](const std::vector<double>& radii) {
    return *std::max_element(radii.begin(), radii.end());
  };
  if (!q.empty()) return largest(p) + largest(q);
  std::vector<double> sorted = p;
  std::partial_sort(sorted.begin(), sorted.begin() + 2, sorted.end(), std::greater<>());
  return sorted[0] + sorted[1];
}

/// Counts a set and its pairs. @return false where there are too many, which is a problem
bool count_set(Assembly& assembly, const LinkEntry& entry, const engine::SetLiaison& set) {
  const config::Place place = entry.reader.place_of(set.set_q.empty() ? "within" : "between_sets");
  if (assembly.scene.network.sets.size() == kMaxSets) {
    assembly.refuse_more(
        place, "the scene has more than " + std::to_string(kMaxSets) + " liaisons of sets");
    return false;
  }
  assembly.set_members += set.set_p.size() + set.set_q.size();
  if (assembly.set_members > kMaxSetMembers) {
    assembly.refuse_more(place, "the sets of the scene have more than " +
                                    std::to_string(kMaxSetMembers) + " MATs together");
    return false;
  }
  const std::size_t surfaces = assembly.count_surfaces(set.set_p);
  assembly.set_surfaces += surfaces;
  if (assembly.set_surfaces > kMaxSetSurfaces) {
    assembly.refuse_more(place, "the sets of the scene have more than " +
                                    std::to_string(kMaxSetSurfaces) + " surfaces together");
    return false;
  }
  if (surfaces > 0 && set.set_p.size() * set.set_q.size() > engine::kMaxSurfacePairs) {
    assembly.refuse_more(place, "the set has more than " +
                                    std::to_string(engine::kMaxSurfacePairs) +
                                    " pairs of a MAT and a surface, near or far");
    return false;
  }
  const engine::StartPairCount pairs = engine::count_start_pairs(
      assembly.scene.network, set,
      {kMaxSetPairs - assembly.set_pairs, kMaxExaminedPairs - assembly.examined_pairs});
  assembly.set_pairs += pairs.in_range;
  assembly.examined_pairs += pairs.examined;
  if (assembly.set_pairs > kMaxSetPairs || assembly.examined_pairs > kMaxExaminedPairs) {
    assembly.refuse_more(place,
                         "the sets of the scene have more than " + std::to_string(kMaxSetPairs) +
                             " pairs of MATs in or near their range at the start",
                         "this one joins all that are nearer than " +
                             config::number_text(set.range) +
                             " m; give it a shorter 'range_m', or fewer MATs");
    return false;
  }
  return true;
}

void add_set(Assembly& assembly, LinkEntry& entry, const std::vector<std::uint32_t>& p,
             const std::vector<std::uint32_t>& q) {
  config::MappingReader& reader = entry.reader;
  if (entry.has_name) {  // so that nothing else has it
    const bool sound = assembly.problems.error_count() == entry.errors_before;
    assembly.names.add({entry.name, Named::kLinks, 0, 0, sound, reader.place_of("name")},
                       assembly.problems);
  }
  const bool has_range = reader.optional_value("range_m").exists();
  const double given_range =
      has_range ? reader.required_number("range_m", config::Range::positive()) : 0.0;
  if (!entry.law || p.empty() || assembly.problems.error_count() != entry.errors_before) return;

  std::vector<LinkLaw> parts = entry.law->beside;
  parts.insert(parts.begin(), *entry.law);
  const auto radii_of = [&](const std::vector<std::uint32_t>& mats) {
    std::vector<double> radii;
    for (const std::uint32_t mat : mats) radii.push_back(assembly.radius_of(mat));
    return radii;
  };
  const double radii = largest_radii(radii_of(p), radii_of(q));
  for (const LinkLaw& part : parts) {
    if (part.kind == LinkKind::kMaxwell) {
      reader.error_at("liaison", "a Maxwell element joins two MATs, not sets");
      return;
    }
    const std::shared_ptr<const engine::StateMachine> state_machine = state_machine_of(part);
    if (assembly.count_surfaces(p) > 0 && has_lennard_jones(*state_machine)) {
      reader.error_at("liaison",
                      "a surface takes no Lennard-Jones law, which has no value inside it",
                      "take rings, a table or an expression");
      return;
    }
    if (rubs(*state_machine) && assembly.scene.space() == 1) {
      reader.error_at("liaison", "space 1 has no direction to slide in, so there is no friction",
                      "take a liaison without 'friction', or 'space: 2'");
      return;
    }
    if (part.rest_length && *part.rest_length < 0.0) {
      reader.error_at(reader.has("rest_m") ? "rest_m" : "liaison",
                      "the rest length of a liaison of sets must be >= 0, got " +
                          config::number_text(*part.rest_length),
                      "a state may have one below 0: 'rest' of an exit");
      return;
    }
    const bool by_radii = !part.rest_length && radii > 0.0 && !part.rest_changes;
    const bool has_rest = part.rest_length || by_radii || part.rest_changes;
    if (!has_rest && depends_on_rest(*state_machine)) {
      reader.error_at("liaison", "a liaison of sets whose MATs have no radius needs a 'rest_m'");
      return;
    }
    engine::SetLiaison set;
    set.set_p = p;
    set.set_q = q;
    set.rest_length = by_radii ? -1.0 : part.rest_length.value_or(0.0);
    set.range = has_range ? given_range
                          : range_of(part, *state_machine, by_radii ? radii : set.rest_length);
    if (set.range <= 0.0) {
      reader.error_at("liaison", "the liaison '" + reader.optional_text("liaison", "") +
                                     "' of sets reaches to any distance, it needs a 'range_m'");
      return;
    }
    const std::string owner = entry.has_name ? assembly.names.full(entry.name) : "";
    if (!count_set(assembly, entry, set)) return;
    set.state_machine =
        part.kind == LinkKind::kState
            ? part.state_machine_index
            : assembly.liaisons->pool().index_of({part.liaison, part.overrides, part.part, owner},
                                                 *state_machine, {});
    const std::string name =
        assembly.names.full(parts.size() == 1 ? entry.name : entry.name + "." + part.part);
    const auto number = static_cast<std::uint32_t>(assembly.scene.network.sets.size());
    if (entry.has_name) {
      assembly.named_sets.emplace(name, number);
    } else {
      assembly.sets_of_liaisons[name].push_back(number);
    }
    assembly.scene.network.sets.push_back(std::move(set));
    assembly.scene.set_names.push_back(name);
    assembly.scene.set_places.push_back(reader.place());
  }
}

}  // namespace

void read_set(Assembly& assembly, LinkEntry& entry) {
  config::MappingReader& reader = entry.reader;
  const Value within = reader.required_value("within");
  const std::optional<Selection> set =
      select(within, "'within' in a link", false, assembly.names, assembly.problems);
  for (const char* other : {"between", "between_sets"}) {
    if (reader.has(other)) reader.error_at(other, kOneOfThem);
    reader.optional_value(other);
  }
  if (set && set->count() == 1)
    reader.error_at("within", "a set of one MAT has no two that could be joined");
  if (set && assembly.count_surfaces(set->indices) > 0)
    reader.error_at("within", kSurfaceInSet, kWriteTwoSets);
  add_set(assembly, entry, set ? set->indices : std::vector<std::uint32_t>{}, {});
}

void read_two_sets(Assembly& assembly, LinkEntry& entry) {
  config::MappingReader& reader = entry.reader;
  const Value both = reader.required_sequence("between_sets");
  if (reader.has("between")) reader.error_at("between", kOneOfThem);
  reader.optional_value("between");
  std::vector<std::vector<std::uint32_t>> sets;
  for (const Value& value : both.items()) {
    const std::optional<Selection> set =
        select(value, "a set of a link", false, assembly.names, assembly.problems);
    sets.push_back(set ? set->indices : std::vector<std::uint32_t>{});
  }
  if (both.exists() && sets.size() != 2) {
    reader.error_at("between_sets", "a link is between 2 sets, got " + std::to_string(sets.size()));
  }
  sets.resize(2);
  std::vector<std::uint32_t> p = sets[0];
  std::sort(p.begin(), p.end());
  const auto shared = std::find_if(sets[1].begin(), sets[1].end(), [&](std::uint32_t mat) {
    return std::binary_search(p.begin(), p.end(), mat);
  });
  if (shared != sets[1].end())
    reader.error_at("between_sets", "the two sets have a MAT in common",
                    "write within: for one set");
  if (sets[0].empty() || sets[1].empty() || !take_surfaces(assembly, reader, sets))
    sets = {{}, {}};  // what is wrong with one has been reported
  add_set(assembly, entry, sets[0], sets[1]);
}

}  // namespace cordis::scene
