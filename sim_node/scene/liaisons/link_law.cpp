// sim_node/scene/liaisons/link_law.cpp
#include "sim_node/scene/liaisons/link_law.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "node/assert.h"
#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/liaisons/liaison_reader.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Problems;
using config::Range;
using config::Value;

constexpr const char* kRest = "rest_m";
constexpr const char* kTension = "tension_n";

/// What a law is read from where a liaison is used.
struct Use {
  MappingReader& reader;
  LawPlace place;
  const Liaisons& liaisons;
  int space;
  const std::string& owner;
};

bool is_linear(const LinkLaw& law) {
  return law.kind == LinkKind::kLinear && law.beside.empty();
}

/// `rest_m` and `rest: radii` for all parts of a law that have a rest length.
void read_rest(const Use& use, LinkLaw& law) {
  MappingReader& reader = use.reader;
  reader.optional_value(kRest);
  const bool radii = reader.optional_choice("rest", "", {"radii"}) == "radii";
  const bool has_length = reader.has(kRest);
  if (has_length && reader.has("rest")) {
    reader.error_at("rest", "either 'rest_m' or 'rest' can be given in " + reader.what());
    return;
  }
  if (!has_length && !radii) return;
  if (law.rest_changes) {
    reader.error_at(
        has_length ? kRest : "rest",
        "the rest length of this liaison follows a formula, and a link gives it no other",
        "leave it out, or use a liaison with a rest_m that is a number");
    return;
  }
  const bool signed_length = use.space == 1 || law.kind == LinkKind::kState;
  const double length =
      has_length ? reader.required_number(kRest, signed_length ? Range{} : Range::not_negative())
                 : 0.0;
  const auto put = [&](LinkLaw& part) {
    part.rest_is_radii = radii;
    part.rest_length = has_length ? std::optional<double>(length) : std::nullopt;
  };
  put(law);
  for (LinkLaw& part : law.beside) put(part);
}

void read_tension(MappingReader& reader, LinkLaw& law) {
  reader.optional_value(kTension);
  if (!reader.has(kTension)) return;
  if (reader.has(kRest)) {
    reader.error_at(kTension, "either 'tension_n' or 'rest_m' can be given in " + reader.what());
  } else if (!is_linear(law)) {
    reader.error_at(kTension, "only a linear liaison can be given a 'tension_n'",
                    "give a 'rest_m' instead");
  } else if (law.stiffness <= 0.0 && reader.ok()) {
    reader.error_at(kTension, "'tension_n' in " + reader.what() + " needs a stiffness > 0");
  }
  law.rest_length.reset();
  law.tension = reader.required_number(kTension);
}

/// The parameters that a link may give are those of its liaison; others that liaisons often have
/// are reported as what they are.
void refuse_foreign_parameters(MappingReader& reader, const Value& definition,
                               const std::vector<std::string>& words) {
  const std::string kind = definition.find("kind").text();
  const auto refuse = [&](const char* key) {
    if (!reader.has(key)) return;
    reader.optional_value(key);
    reader.error_at(key, "a " + kind + " has no '" + key + "'");
  };
  const auto has = [&](const char* key) {
    return std::find(words.begin(), words.end(), key) != words.end();
  };
  if (kind == "spring" && !has(kViscosity)) refuse(kViscosity);
  if (kind == "damper") {
    if (!has(kStiffness)) refuse(kStiffness);
    refuse(kRest);
    refuse(kTension);
  }
  if (kind == "maxwell" || kind == kBending) {
    refuse(kRest);
    refuse(kTension);
  }
}

/// Values that the use gives to parameters of the liaison.
ParameterOverrides read_overrides(MappingReader& reader, const std::vector<std::string>& words) {
  ParameterOverrides overrides;
  for (const std::string& word : words) {
    const bool has_range = word == kStiffness || word == kViscosity || word == kBendStiffness ||
                           word == kBendViscosity;
    reader.optional_value(word);
    if (!reader.has(word)) continue;
    overrides[word] = reader.required_number(word, has_range ? Range::not_negative() : Range{});
  }
  return overrides;
}

/// Gives the states of a law their place in the network.
void place_state_machines(const Use& use, const std::string& liaison,
                          const ParameterOverrides& overrides, LinkLaw& law) {
  const auto put = [&](LinkLaw& part) {
    part.liaison = liaison;
    part.overrides = overrides;
    if (part.state_machine == nullptr) return;
    part.state_machine_index = use.liaisons.pool().index_of(
        {liaison, overrides, part.part, use.owner}, *part.state_machine, part.references);
  };
  put(law);
  for (LinkLaw& part : law.beside) put(part);
}

std::optional<LinkLaw> law_of_liaison(const Use& use, const Value& name, const Liaison& liaison) {
  MappingReader& reader = use.reader;
  const std::vector<std::string> words = parameters_of(liaison.definition);
  refuse_foreign_parameters(reader, liaison.definition, words);
  const ParameterOverrides overrides = read_overrides(reader, words);
  LinkLaw law = liaison.law;
  if (!overrides.empty() && reader.ok()) {
    Problems scratch;
    std::optional<LinkLaw> changed = read_liaison(liaison.definition, name.text(), overrides,
                                                  use.liaisons, use.space, false, scratch);
    if (!changed) {
      reader.error_at(overrides.begin()->first,
                      "the liaison '" + name.text() +
                          "' cannot have these parameters: " + scratch.all().front().message);
      return std::nullopt;
    }
    law = std::move(*changed);
  }
  read_rest(use, law);
  if (use.place == LawPlace::kMatter) read_tension(reader, law);
  if (reader.ok()) place_state_machines(use, name.text(), overrides, law);
  return law;
}

}  // namespace

bool rubs(const LinkLaw& law) {
  return (law.state_machine != nullptr && engine::rubs(*law.state_machine)) ||
         std::any_of(law.beside.begin(), law.beside.end(), rubs);
}

std::shared_ptr<const engine::StateMachine> state_machine_of(const LinkLaw& law) {
  if (law.state_machine != nullptr) return law.state_machine;
  engine::StateMachine state_machine;
  engine::LinkState& state = state_machine.states.emplace_back();
  state.stiffness = law.bend ? law.bend->stiffness : law.stiffness;
  state.viscosity = law.bend ? law.bend->viscosity : law.viscosity;
  return std::make_shared<const engine::StateMachine>(std::move(state_machine));
}

bool StateMachinePool::Origin::operator<(const Origin& other) const {
  return std::tie(liaison, overrides, part, owner, scope) <
         std::tie(other.liaison, other.overrides, other.part, other.owner, other.scope);
}

std::uint32_t StateMachinePool::index_of(Origin origin, const engine::StateMachine& state_machine,
                                         const std::vector<VariableReference>& references) {
  if (!references.empty()) origin.scope = scope_;
  const auto next = static_cast<std::uint32_t>(state_machines_.size());
  const auto [known, is_new] = indices_.emplace(std::move(origin), next);
  if (is_new) {
    state_machines_.push_back(state_machine);
    references_.push_back(references);
    bindings_.emplace_back();
  }
  return known->second;
}

void StateMachinePool::bind(std::uint32_t index, Bindings bindings) {
  bindings_[index] = std::move(bindings);
  bind_as(index, references_[index], state_machines_[index]);
}

void StateMachinePool::bind_as(std::uint32_t index,
                               const std::vector<VariableReference>& references,
                               engine::StateMachine& state_machine) const {
  const Bindings& bindings = bindings_[index];
  const std::vector<VariableReference>& own = references_[index];
  const auto put = [&](engine::Program& program) {
    for (engine::Instruction& instruction : program.code) {
      if (instruction.operation != engine::Operation::kVariable) continue;
      CORDIS_ASSERT(instruction.slot < references.size());
      const VariableReference& wanted = references[instruction.slot];
      const auto same = std::ranges::find_if(own, [&](const VariableReference& known) {
        return known.owner == wanted.owner && known.word == wanted.word &&
               known.state == wanted.state;
      });
      CORDIS_ASSERT(same != own.end());
      instruction = bindings[static_cast<std::size_t>(same - own.begin())];
    }
  };
  for (engine::Transition& exit : state_machine.exits) put(exit.when);
  for (engine::LinkState& state : state_machine.states) {
    for (engine::Law* law : {&state.elasticity, &state.dissipation}) {
      if (auto* expression = std::get_if<engine::Expression>(law)) put(expression->program);
    }
    for (engine::ParameterFormula& each : state.formulas) put(each.formula);
  }
}

std::optional<LinkLaw> read_law(MappingReader& reader, LawPlace place, const Liaisons& liaisons,
                                int space, const std::string& owner) {
  const bool sound_before = reader.ok();
  if (place == LawPlace::kMatter) {
    reader.describe({.key = kStiffness,
                     .kind = config::KeyKind::kNumber,
                     .required = true,
                     .range = Range::not_negative(),
                     .alternatives = {"liaison", "fixed", "driven"}});
  }
  const Use use{reader, place, liaisons, space, owner};
  const Value name = place == LawPlace::kLink ? reader.required_value("liaison")
                                              : reader.optional_value("liaison");
  Problems of_name;
  const bool with_hint = !reader.problems().is_full();
  const Liaison* const liaison = name.exists() ? liaisons.find(name, of_name, with_hint) : nullptr;
  for (const config::Problem& problem : of_name.all())
    reader.error_at("liaison", problem.message, problem.hint);
  std::optional<LinkLaw> law;
  if (liaison != nullptr) {
    law = law_of_liaison(use, name, *liaison);
    if (law && place == LawPlace::kMatter && rubs(*law))
      reader.error_at("liaison", "friction acts in liaisons of sets, not between neighbours");
    if (law && place == LawPlace::kMatter && law->bend)
      reader.error_at("liaison", "a bending liaison joins three MATs, not two neighbours",
                      "write a link with it: along: matter");
  } else if (!name.exists() && place == LawPlace::kMatter) {
    law.emplace();
    law->stiffness = reader.required_number(kStiffness, Range::not_negative());
    law->viscosity = reader.optional_number(kViscosity, 0.0, Range::not_negative());
    read_rest(use, *law);
    read_tension(reader, *law);
  } else {  // nothing sure can be said about the keys of a liaison that is not known
    for (const std::string& key : reader.present_keys()) reader.optional_value(key);
  }
  if (sound_before && !reader.ok()) return std::nullopt;
  return law;
}

std::size_t LinkLists::count(LinkKind kind) const noexcept {
  if (kind == LinkKind::kLinear) return links.size();
  return kind == LinkKind::kState ? state_links.size() : maxwell_links.size();
}

bool LinkLists::join(const LinkLaw& law, std::uint32_t a, std::uint32_t b,
                     const engine::Vec3& position_a, const engine::Vec3& position_b, int space,
                     double radii) {
  bool possible = join_alone(law, a, b, position_a, position_b, space, radii);
  for (const LinkLaw& part : law.beside)
    possible = join_alone(part, a, b, position_a, position_b, space, radii) && possible;
  return possible;
}

bool LinkLists::join_alone(const LinkLaw& law, std::uint32_t a, std::uint32_t b,
                           const engine::Vec3& position_a, const engine::Vec3& position_b,
                           int space, double radii) {
  const engine::Vec3 along = position_b - position_a;
  const double distance = space == 1 ? along.x() : along.norm();
  double rest = law.rest_length.value_or(law.rest_is_radii ? radii : distance);
  if (law.tension) rest = distance - *law.tension / law.stiffness;
  switch (law.kind) {
    case LinkKind::kLinear:
      links.push_back({a, b, law.stiffness, law.viscosity, rest});
      return space == 1 || rest >= 0.0;
    case LinkKind::kState:
      state_links.push_back({a, b, law.state_machine_index, rest});
      break;
    case LinkKind::kMaxwell:
      maxwell_links.push_back(
          {a, b, law.stiffness, law.viscosity, law.start_force,
           law.state_machine == nullptr ? engine::MaxwellLink::kNone : law.state_machine_index});
      break;
    case LinkKind::kBend:
      CORDIS_ASSERT(false && "a bend joins three MATs");
      break;
  }
  return true;
}

void LinkLists::append(const LinkLists& more, std::uint32_t first_mat) {
  const auto add = [&](auto& list, const auto& others) {
    for (auto link : others) {
      link.mat_a += first_mat;
      link.mat_b += first_mat;
      list.push_back(link);
    }
  };
  add(links, more.links);
  add(state_links, more.state_links);
  add(maxwell_links, more.maxwell_links);
}

}  // namespace cordis::scene
