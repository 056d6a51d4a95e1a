// sim_node/scene/sections/sets.cpp -- liaisons of the `links:` section within a set of MATs, or
// between two sets. [Luc90 III.2.3 a formalism for inter-connection]
#include <algorithm>
#include <utility>

#include "sim_node/scene/liaisons/law.h"
#include "sim_node/scene/sections/assembly.h"

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

/// How far apart two MATs may be to be joined [m]; 0 when nothing limits it.
double range_of(const LinkLaw& law, const engine::StateMachine& state_machine, double rest) {
  if (law.reach.rule == Reach::Rule::kLength) return law.reach.length;
  return law.reach.rule == Reach::Rule::kRest ? rest : reach_of_all(state_machine);
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

}  // namespace

void Assembly::read_set(LinkEntry& entry) {
  config::MappingReader& reader = entry.reader;
  const Value within = reader.required_value("within");
  const std::optional<Selection> set =
      select(within, "'within' in a link", false, names_, problems_);
  for (const char* other : {"between", "between_sets"}) {
    if (reader.has(other)) reader.error_at(other, kOneOfThem);
    reader.optional_value(other);
  }
  if (set && set->count() == 1)
    reader.error_at("within", "a set of one MAT has no two that could be joined");
  add_set(entry, set ? set->indices : std::vector<std::uint32_t>{}, {});
}

void Assembly::read_two_sets(LinkEntry& entry) {
  config::MappingReader& reader = entry.reader;
  const Value both = reader.required_sequence("between_sets");
  if (reader.has("between")) reader.error_at("between", kOneOfThem);
  reader.optional_value("between");
  std::vector<std::vector<std::uint32_t>> sets;
  for (const Value& value : both.items()) {
    const std::optional<Selection> set = select(value, "a set of a link", false, names_, problems_);
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
  if (sets[0].empty() || sets[1].empty())
    sets = {{}, {}};  // what is wrong with one has been reported
  add_set(entry, sets[0], sets[1]);
}

void Assembly::add_set(LinkEntry& entry, const std::vector<std::uint32_t>& p,
                       const std::vector<std::uint32_t>& q) {
  config::MappingReader& reader = entry.reader;
  if (entry.has_name) {  // so that nothing else bears it
    const bool sound = problems_.error_count() == entry.errors_before;
    names_.add({entry.name, Named::kLinks, 0, 0, sound, reader.place_of("name")}, problems_);
  }
  const bool has_range = reader.optional_value("range_m").exists();
  const double given_range =
      has_range ? reader.required_number("range_m", config::Range::positive()) : 0.0;
  if (!entry.law || p.empty() || problems_.error_count() != entry.errors_before) return;

  std::vector<LinkLaw> parts = entry.law->beside;
  parts.insert(parts.begin(), *entry.law);
  const auto radii_of = [&](const std::vector<std::uint32_t>& mats) {
    std::vector<double> radii;
    for (const std::uint32_t mat : mats) radii.push_back(radius_of(mat));
    return radii;
  };
  const double radii = largest_radii(radii_of(p), radii_of(q));
  for (const LinkLaw& part : parts) {
    if (part.kind == LinkKind::kMaxwell) {
      reader.error_at("liaison", "a Maxwell element joins two MATs, not sets");
      return;
    }
    const std::shared_ptr<const engine::StateMachine> state_machine = state_machine_of(part);
    const bool by_radii = !part.rest_length && radii > 0.0;
    if (!part.rest_length && !by_radii && depends_on_rest(*state_machine)) {
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
    const std::string owner = entry.has_name ? names_.full(entry.name) : "";
    set.state_machine = part.kind == LinkKind::kState
                            ? part.state_machine_index
                            : liaisons_->pool().index_of(
                                  {part.liaison, part.given, part.part, owner}, *state_machine);
    const std::string name =
        names_.full(parts.size() == 1 ? entry.name : entry.name + "." + part.part);
    if (entry.has_name) {
      named_sets_.emplace(name, static_cast<std::uint32_t>(scene_.network.sets.size()));
    }
    scene_.network.sets.push_back(std::move(set));
    scene_.set_names.push_back(name);
    scene_.set_places.push_back(reader.place());
  }
}

}  // namespace cordis::scene
