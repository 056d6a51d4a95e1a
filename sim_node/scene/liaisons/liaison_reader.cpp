// sim_node/scene/liaisons/liaison_reader.cpp
#include "sim_node/scene/liaisons/liaison_reader.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "sim_node/scene/liaisons/diagnostics.h"
#include "sim_node/scene/liaisons/state_machine.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Problems;
using config::Range;
using config::Value;

constexpr std::size_t kMaxParts = 64;  // of a parallel liaison, those in its parts counted too

constexpr const char* kRestLength = "rest_m";
constexpr const char* kStartForce = "start_force_n";

/// A kind of liaison, and its keys that a link may give a value to.
struct LiaisonKind {
  const char* name;
  bool has_stiffness;
  bool has_viscosity;
};
constexpr std::array<LiaisonKind, 7> kLiaisonKinds{{
    {"spring", true, false},
    {"damper", false, true},
    {"spring_damper", true, true},
    {"maxwell", true, true},
    {"state_machine", true, true},
    {"parallel", false, false},
    {kBending, false, false},
}};

/// The kind that a liaison is of by its keys; empty when it must be written.
std::string kind_by_keys(const Value& definition) {
  if (definition.find("parallel").exists()) return "parallel";
  return looks_like_state_machine(definition) ? "state_machine" : "";
}

/// What to do where a kind lacks one of its numbers.
std::string hint_without(const std::string& kind, const std::string& key) {
  if (kind != "spring_damper") return {};
  return std::string("give it, or write kind: ") + (key == kViscosity ? "spring" : "damper");
}

/// The first key of bending in one mapping, if none of links stands beside it.
std::optional<Value::Entry> bending_key_in(const Value& mapping) {
  constexpr std::array kOfBending{kBendStiffness, kBendViscosity, kBendRest};
  constexpr std::array kOfLinks{kStiffness,      kViscosity, "elasticity", "dissipation",
                                "force_limit_n", "pulls",    "pushes",     "friction"};
  std::optional<Value::Entry> found;
  for (const Value::Entry& entry : mapping.entries()) {
    if (std::ranges::find(kOfLinks, entry.key) != kOfLinks.end()) return {};
    if (!found && std::ranges::find(kOfBending, entry.key) != kOfBending.end()) found = entry;
  }
  return found;
}

/// Likewise of a liaison or, where it has none itself, of its states.
std::optional<Value::Entry> bending_key_of(const Value& definition) {
  if (definition.find("parallel").exists()) return {};
  if (auto own = bending_key_in(definition)) return own;
  for (const Value::Entry& state : definition.find("states").entries())
    if (auto found = bending_key_in(state.value)) return found;
  return {};
}

/// The definition with overrides in the place of its plain keys.
Value with_overrides(const Value& definition, const ParameterOverrides& overrides) {
  Value changed = definition;
  for (const auto& [name, number] : overrides) {
    if (definition.find("parameters").find(name).exists()) continue;
    changed = config::with_value_at(
        changed, {name}, Value::scalar(config::number_text(number), definition.find(name).place()));
  }
  return changed;
}

class LiaisonReader {
 public:
  /// @param open  the liaisons of which this one is a part, the outermost first, and itself
  LiaisonReader(const Liaisons& liaisons, std::vector<std::string> open, int space,
                bool with_diagnostics, Problems& problems)
      : liaisons_(liaisons),
        open_(std::move(open)),
        space_(space),
        with_diagnostics_(with_diagnostics),
        problems_(problems) {}

  LinkLaw read(const Value& written, const std::string& what, const ParameterOverrides& overrides,
               const ParameterValues* outer) {
    LinkLaw law;
    const Value definition = with_overrides(written, overrides);
    MappingReader reader(definition, what, problems_);
    if (!reader.has("kind") && lacks_kind_of_bending(definition, what)) return law;
    std::string kind = kind_by_keys(definition);
    if (kind.empty() || reader.has("kind")) {
      std::vector<std::string> words;
      for (const LiaisonKind& known : kLiaisonKinds) words.emplace_back(known.name);
      kind = reader.required_choice("kind", words,
                                    "; a liaison with states or a law, as elasticity, needs none");
    }
    reader.optional_value("kind");
    if (!reader.ok() || (kind != kBending && lacks_kind_of_bending(definition, what)) ||
        (kind == "state_machine" && has_plain_friction(definition, what)))
      return law;

    const std::size_t errors_before = problems_.error_count();
    const ParameterValues parameters(reader.optional_value("parameters"), overrides, outer, what,
                                     problems_);
    if (problems_.error_count() != errors_before) return law;
    if (kind == "parallel") {
      law = read_parallel(reader, parameters);
    } else if (kind == "state_machine") {
      law = read_states(reader, parameters);
    } else if (kind == kBending) {
      law = read_bend(reader, parameters);
    } else if (changes(written, kind, parameters)) {
      law = read_changing(reader, kind, parameters);
    } else {
      law = read_linear(reader, kind, parameters);
    }
    reader.finish();
    if (!with_diagnostics_ || problems_.error_count() != errors_before) return law;
    parameters.warn_of_unused(definition.find("parameters"), what, problems_);
    return law;
  }

 private:
  /// True, with a problem, if a liaison of another kind is written as one of bending.
  bool lacks_kind_of_bending(const Value& definition, const std::string& what) {
    const std::optional<Value::Entry> key = bending_key_of(definition);
    if (!key) return false;
    problems_.error(key->key_place,
                    "'" + key->key + "' is a key of a bending liaison, and " + what + " is none",
                    "write kind: bending in " + what);
    return true;
  }

  /// True, with a problem, if friction is written as a number, in the liaison or a state.
  bool has_plain_friction(const Value& definition, const std::string& what) {
    const Value friction = definition.find("friction");
    if (friction.kind() == Value::Kind::kScalar && friction.text() != "none") {
      problems_.error(
          friction.place(),
          "'friction' in " + what + " must be a mapping of keys, got " + friction.described(),
          std::string("for example ") + kExampleOfFriction);
      return true;
    }
    const std::vector<Value::Entry>& states = definition.find("states").entries();
    return std::ranges::any_of(states, [&](const Value::Entry& state) {
      return has_plain_friction(state.value, "state '" + state.key + "' of " + what);
    });
  }

  static void refuse_friction(MappingReader& reader, const std::string& kind) {
    if (!reader.has("friction")) return;
    reader.optional_value("friction");
    reader.error_at("friction", "a " + kind + " has no 'friction'",
                    "leave 'kind' out: a liaison with friction is a state_machine");
  }

  LinkLaw read_linear(MappingReader& reader, const std::string& kind_name,
                      const ParameterValues& parameters) {
    const LiaisonKind& kind =
        *std::find_if(kLiaisonKinds.begin(), kLiaisonKinds.end(),
                      [&](const LiaisonKind& known) { return kind_name == known.name; });
    LinkLaw law;
    const bool maxwell = kind_name == "maxwell";
    if (maxwell) law.kind = LinkKind::kMaxwell;
    const auto refuse = [&](const char* key) {
      reader.optional_value(key);
      if (reader.has(key)) reader.error_at(key, "a " + kind_name + " has no '" + key + "'");
    };
    refuse_friction(reader, kind_name);
    const Range range = maxwell ? Range::positive() : Range::not_negative();
    const double fallback = maxwell ? 1.0 : 0.0;
    const auto required = [&](const char* key) {
      AskedOutside outside{liaisons_.signals(), law.references};
      reader.required_value(key, hint_without(kind_name, key));
      return optional_changing(reader, key, fallback, range, parameters, outside, problems_);
    };
    ChangingNumber stiffness;
    ChangingNumber viscosity;
    if (kind.has_stiffness) {
      stiffness = required(kStiffness);
    } else {
      refuse(kStiffness);
    }
    if (kind.has_viscosity) {
      viscosity = required(kViscosity);
    } else {
      refuse(kViscosity);
    }
    law.stiffness = stiffness.number;
    law.viscosity = viscosity.number;
    if (maxwell && (stiffness.changes() || viscosity.changes()))
      follow(reader, stiffness, viscosity, law);
    if (kind.has_stiffness && !maxwell) {
      read_rest(reader, law, parameters);
    } else {
      refuse(kRestLength);
    }
    if (maxwell)
      law.start_force = optional_formula(reader, kStartForce, 0.0, Range{}, parameters, problems_);
    return law;
  }

  /// Gives a Maxwell element a state machine of one state, from which it takes K and Z.
  void follow(const MappingReader& reader, const ChangingNumber& stiffness,
              const ChangingNumber& viscosity, LinkLaw& law) {
    law.stiffness = law.viscosity = 0.0;
    BendParameters parameters;
    parameters.stiffness = stiffness;
    parameters.viscosity = viscosity;
    take_state(reader, state_of(parameters), law);
  }

  /// Gives a law a state machine of this state alone, once that has been checked.
  void take_state(const MappingReader& reader, engine::LinkState state, LinkLaw& law) {
    engine::StateMachine machine;
    machine.name = open_.back();
    machine.states.push_back(std::move(state));
    try {
      engine::check_state_machine(machine, reader.what(), law.references.size());
    } catch (const std::invalid_argument& refusal) {
      problems_.error(reader.place(), refusal.what());
      return;
    }
    law.state_machine = std::make_shared<const engine::StateMachine>(std::move(machine));
  }

  /// True if a parameter of a linear liaison is a formula that asks for something outside the link.
  bool changes(const Value& written, const std::string& kind,
               const ParameterValues& parameters) const {
    if (kind == "maxwell") return false;
    return std::ranges::any_of(
        std::array{kStiffness, kViscosity, kRestLength}, [&](const char* key) {
          return asks_outside(written.find(key), parameters, liaisons_.signals());
        });
  }

  /// A spring or damper whose parameters change, as one state: K (distance - rest) and Z times the speed.
  LinkLaw read_changing(MappingReader& reader, const std::string& kind,
                        const ParameterValues& parameters) {
    LinkLaw law;
    law.kind = LinkKind::kState;
    AskedOutside outside{liaisons_.signals(), law.references};
    const std::size_t errors_before = problems_.error_count();
    refuse_friction(reader, kind);
    const auto read = [&](const char* key, bool is_its_own, bool is_required) {
      if (!is_its_own) {
        reader.optional_value(key);
        if (reader.has(key)) reader.error_at(key, "a " + kind + " has no '" + key + "'");
        return ChangingNumber{};
      }
      if (is_required) reader.required_value(key, hint_without(kind, key));
      return optional_changing(reader, key, 0.0,
                               key == kRestLength ? Range{} : Range::not_negative(), parameters,
                               outside, problems_);
    };
    const ChangingNumber stiffness = read(kStiffness, kind != "damper", true);
    const ChangingNumber viscosity = read(kViscosity, kind != "spring", true);
    const bool rest_changes =
        asks_outside(reader.optional_value(kRestLength), parameters, liaisons_.signals());
    ChangingNumber rest;
    if (rest_changes && kind != "damper") {
      rest = read(kRestLength, true, false);
      law.rest_changes = true;
      reader.optional_choice("rest", "", {"radii"});
      if (reader.has("rest"))
        reader.error_at("rest", "either 'rest_m' or 'rest' can be given in " + reader.what());
    } else if (kind == "damper") {
      read(kRestLength, false, false);
    } else {
      read_rest(reader, law, parameters);
    }
    if (problems_.error_count() != errors_before) return law;
    engine::LinkState state;
    if (stiffness.changes() || rest.changes()) {
      state.elasticity = engine::Expression{elasticity_of(stiffness, rest)};
    } else {
      state.stiffness = stiffness.number;
    }
    if (viscosity.changes()) {
      state.dissipation =
          engine::Expression{product_of(viscosity.program, engine::Quantity::kSpeed)};
    } else {
      state.viscosity = viscosity.number;
    }
    take_state(reader, std::move(state), law);
    return law;
  }

  /// K times the elongation, or times distance - rest where the rest changes.
  static engine::Program elasticity_of(const ChangingNumber& stiffness,
                                       const ChangingNumber& rest) {
    engine::Program program = stiffness.program;
    if (!stiffness.changes())
      program.code.push_back({engine::Operation::kConstant, {}, stiffness.number, 0});
    if (!rest.changes()) return product_of(program, engine::Quantity::kElongation);
    program.code.push_back({engine::Operation::kQuantity, engine::Quantity::kDistance, 0, 0});
    program.code.insert(program.code.end(), rest.program.code.begin(), rest.program.code.end());
    program.code.push_back({engine::Operation::kSubtract, {}, 0.0, 0});
    program.code.push_back({engine::Operation::kMultiply, {}, 0.0, 0});
    return program;
  }

  /// `rest_m` or `rest: radii`.
  void read_rest(MappingReader& reader, LinkLaw& law, const ParameterValues& parameters) {
    const bool signed_length = space_ == 1 || law.kind == LinkKind::kState;
    const Range range = signed_length ? Range{} : Range::not_negative();
    const Value rest = reader.optional_value(kRestLength);
    if (rest.exists())
      law.rest_length =
          read_formula(rest, "'rest_m' in " + reader.what(), 0.0, range, parameters, problems_);
    law.rest_is_radii = reader.optional_choice("rest", "", {"radii"}) == "radii";
    if (reader.has(kRestLength) && reader.has("rest"))
      reader.error_at("rest", "either 'rest_m' or 'rest' can be given in " + reader.what());
  }

  LinkLaw read_states(MappingReader& reader, const ParameterValues& parameters) {
    LinkLaw law;
    law.kind = LinkKind::kState;
    const std::size_t errors_before = problems_.error_count();
    StateMachinePlaces places;
    AskedOutside outside{liaisons_.signals(), law.references};
    engine::StateMachine state_machine =
        read_state_machine(reader, parameters, outside, places, problems_);
    read_rest(reader, law, parameters);
    law.reach = read_reach(reader, parameters);
    if (problems_.error_count() != errors_before) return law;
    return with_states(reader, std::move(law), std::move(state_machine), places);
  }

  LinkLaw read_bend(MappingReader& reader, const ParameterValues& parameters) {
    LinkLaw law;
    law.kind = LinkKind::kBend;
    const std::size_t errors_before = problems_.error_count();
    AskedOutside outside{liaisons_.signals(), law.references};
    std::optional<BendParameters> changing;
    law.bend = read_bend_law(reader, space_, parameters, outside, problems_, changing);
    if (changing && problems_.error_count() == errors_before)
      take_state(reader, state_of(*changing), law);
    if (!reader.has("states")) return law;
    StateMachinePlaces places;
    engine::StateMachine state_machine =
        read_bend_states(reader, space_, parameters, outside, places, problems_);
    if (problems_.error_count() != errors_before) return law;
    const std::optional<double> rest = state_machine.states[state_machine.start].rest_angle;
    if (rest) law.bend->rest_angle = *rest;
    return with_states(reader, std::move(law), std::move(state_machine), places);
  }

  /// The law with its state machine, once that has been checked.
  LinkLaw with_states(const MappingReader& reader, LinkLaw law, engine::StateMachine state_machine,
                      const StateMachinePlaces& places) {
    state_machine.name = open_.back();
    try {
      engine::check_state_machine(state_machine, reader.what(), law.references.size());
    } catch (const std::invalid_argument& refusal) {
      problems_.error(reader.place(), refusal.what());
      return law;
    }
    if (with_diagnostics_)
      diagnose(state_machine, places, law.bend.has_value(), reader.what(), problems_);
    law.state_machine = std::make_shared<const engine::StateMachine>(std::move(state_machine));
    return law;
  }

  /// `range_m` or `range: rest`.
  Reach read_reach(MappingReader& reader, const ParameterValues& parameters) {
    const bool as_rest = reader.optional_choice("range", "", {"rest"}) == "rest";
    const double length =
        optional_formula(reader, "range_m", 0.0, Range::positive(), parameters, problems_);
    if (reader.has("range_m") && reader.has("range"))
      reader.error_at("range", "either 'range_m' or 'range' can be given in " + reader.what());
    if (as_rest) return {Reach::Rule::kRest, 0.0};
    return length > 0.0 ? Reach{Reach::Rule::kLength, length} : Reach{};
  }

  LinkLaw read_parallel(MappingReader& reader, const ParameterValues& parameters) {
    const Value list = reader.required_sequence("parallel");
    if (list.exists() && list.items().empty())
      reader.error_at("parallel", "'parallel' in " + reader.what() + " must not be empty");
    std::vector<LinkLaw> parts;
    for (const Value& item : list.items()) {
      const std::size_t errors_before = problems_.error_count();
      const LinkLaw part = read_part(item, reader.what(), parameters);
      if (problems_.error_count() != errors_before) return {};
      if (part.bend) {
        problems_.error(item.place(),
                        "a bending liaison joins three MATs, so it stands in no 'parallel'",
                        "write a link of its own with it");
        return {};
      }
      std::vector<LinkLaw> all = part.beside;
      all.insert(all.begin(), part);
      for (LinkLaw& one : all) {
        one.beside.clear();
        if (parts.size() < kMaxParts) parts.push_back(std::move(one));
      }
      if (parts.size() < kMaxParts) continue;
      reader.error_at("parallel", "'parallel' in " + reader.what() + " has too many parts");
      break;
    }
    if (parts.empty()) return {};
    name_parts(parts);
    LinkLaw law = parts.front();
    law.beside.assign(parts.begin() + 1, parts.end());
    return law;
  }

  LinkLaw read_part(const Value& item, const std::string& what, const ParameterValues& parameters) {
    const std::string name = item.kind() == Value::Kind::kScalar ? item.text() : std::string{};
    LinkLaw law;
    if (item.kind() == Value::Kind::kMapping) {
      const Value definition = liaisons_.completed(item, problems_);
      if (!definition.exists()) return law;
      law = read(definition, "a part of " + what, {}, &parameters);
      const Value like = item.find("like");
      if (law.part.empty()) law.part = like.exists() ? like.text() : item.find("kind").text();
      return law;
    }
    if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
      std::string circle;
      for (const std::string& open : open_) circle += open + " -> ";
      problems_.error(item.place(), "the liaison '" + name + "' stands in parallel with itself",
                      circle + name);
      return law;
    }
    if (open_.size() >= kMaxParts) {
      problems_.error(item.place(), "more than " + std::to_string(kMaxParts) +
                                        " liaisons stand in parallel within each other");
      return law;
    }
    const Liaison* const liaison = liaisons_.find(item, problems_);
    if (liaison == nullptr) return law;
    std::vector<std::string> open = open_;
    open.push_back(name);
    Problems elsewhere;  // what is wrong in a liaison of its own is reported there
    LiaisonReader reader(liaisons_, std::move(open), space_, false, elsewhere);
    law = reader.read(liaison->definition, "liaison '" + name + "'", {}, nullptr);
    if (elsewhere.has_errors()) {
      problems_.error(item.place(), "the liaison '" + name + "' cannot be used here",
                      elsewhere.all().front().message);
    }
    if (law.part.empty()) law.part = name;
    return law;
  }

  /// Gives equal names a number.
  static void name_parts(std::vector<LinkLaw>& parts) {
    std::map<std::string, int> uses;
    for (LinkLaw& part : parts) {
      const int use = ++uses[part.part];
      if (use > 1) part.part += std::to_string(use);
    }
  }

  const Liaisons& liaisons_;
  std::vector<std::string> open_;
  int space_;
  bool with_diagnostics_;
  Problems& problems_;
};

}  // namespace

std::optional<LinkLaw> read_liaison(const Value& definition, const std::string& name,
                                    const ParameterOverrides& overrides, const Liaisons& liaisons,
                                    int space, bool with_diagnostics, Problems& problems) {
  const std::size_t errors_before = problems.error_count();
  LiaisonReader reader(liaisons, {name}, space, with_diagnostics, problems);
  LinkLaw law = reader.read(definition, "liaison '" + name + "'", overrides, nullptr);
  if (problems.error_count() != errors_before) return std::nullopt;
  return law;
}

std::vector<std::string> parameters_of(const Value& definition) {
  std::vector<std::string> names;
  for (const Value::Entry& entry : definition.find("parameters").entries())
    names.push_back(entry.key);
  if (definition.find("parallel").exists() || definition.find("states").exists()) return names;
  for (const char* key :
       {kStiffness, kViscosity, "force_limit_n", kBendStiffness, kBendViscosity}) {
    const bool known = std::find(names.begin(), names.end(), key) != names.end();
    if (definition.find(key).exists() && !known) names.emplace_back(key);
  }
  return names;
}

}  // namespace cordis::scene
