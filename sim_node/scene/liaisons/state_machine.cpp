// sim_node/scene/liaisons/state_machine.cpp
#include "sim_node/scene/liaisons/state_machine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "sim_node/engine/description/bend_limits.h"
#include "sim_node/scene/liaisons/bend_law.h"
#include "sim_node/scene/liaisons/law.h"

namespace cordis::scene {

namespace {

using config::Problems;
using config::Range;
using config::Value;
using engine::LinkState;
using engine::Transition;

constexpr std::size_t kMaxExits = 1'000;  // of a liaison
constexpr double kMaxViscosity = 1e300;   // a number also over the shortest step [N s/m]

/// What a state's exits are read from.
struct ExitSource {
  const ParameterValues& parameters;
  const std::vector<std::string>& states;  // their names
  AskedOutside& outside;
  Problems& problems;
  ExpressionOwner owner = ExpressionOwner::kLink;
  int space = 0;  // of a bend
};

/// Adds a parameter that changes, times what it is a slope over, to the law beside it.
void add_changing(config::MappingReader& reader, const char* key, const ChangingNumber& parameter,
                  engine::Quantity over, engine::Law& law) {
  if (!parameter.changes()) return;
  engine::Program program = product_of(parameter.program, over);
  if (const auto* beside = std::get_if<engine::Expression>(&law)) {
    program.code.insert(program.code.end(), beside->program.code.begin(),
                        beside->program.code.end());
    program.code.push_back({engine::Operation::kAdd, {}, 0.0, 0});
  } else if (!is_none(law)) {
    reader.error_at(key,
                    std::string("'") + key + "' in " + reader.what() +
                        " changes, and stands beside a law that is no expression",
                    "write the law as an expression, or two liaisons in 'parallel'");
    return;
  }
  law = engine::Expression{std::move(program)};
}

LinkState read_physics(config::MappingReader& reader, const ParameterValues& parameters,
                       AskedOutside& outside, Problems& problems) {
  const Range not_negative = Range::not_negative();
  LinkState state;
  const ChangingNumber stiffness = optional_changing(reader, "stiffness_n_per_m", 0.0, not_negative,
                                                     parameters, outside, problems);
  const ChangingNumber viscosity =
      optional_changing(reader, "viscosity_n_s_per_m", 0.0, Range::between(0.0, kMaxViscosity),
                        parameters, outside, problems);
  state.stiffness = stiffness.number;
  state.viscosity = viscosity.number;
  state.elasticity = read_elasticity(reader, parameters, outside, problems, state.formulas);
  state.dissipation = read_dissipation(reader, parameters, outside, problems);
  add_changing(reader, "stiffness_n_per_m", stiffness, engine::Quantity::kElongation,
               state.elasticity);
  add_changing(reader, "viscosity_n_s_per_m", viscosity, engine::Quantity::kSpeed,
               state.dissipation);
  state.force_limit = optional_formula(reader, "force_limit_n", state.force_limit,
                                       Range::positive(), parameters, problems);
  state.pulls = reader.optional_truth("pulls", true);
  state.pushes = reader.optional_truth("pushes", true);
  return state;
}

void read_rest(config::MappingReader& reader, const ExitSource& source, Transition& exit) {
  const Value rest = reader.optional_value("rest");
  if (!rest.exists()) return;
  const bool is_of_bend = source.owner == ExpressionOwner::kBend;
  if (is_of_bend && source.space == 3) {
    source.problems.error(rest.place(),
                          "in 3 dimensions a bend has no sign, so its rest stays straight",
                          "leave 'rest' out");
    return;
  }
  if (rest.text() == "keep") {
    if (!is_of_bend) return;
    exit.rest = engine::RestRule::kExpression;  // also into a state that has its own
    exit.rest_length.code.push_back(
        {engine::Operation::kQuantity, engine::Quantity::kRestAngle, 0.0, 0});
    return;
  }
  if (rest.text() == "here") {
    exit.rest = engine::RestRule::kHere;
    return;
  }
  const std::string what = "'rest' in " + reader.what();
  const std::optional<Expression> expression = parse_expression(rest, what, source.problems);
  if (!expression) return;
  std::uint32_t slots = 0;
  std::optional<CompiledExpression> compiled =
      compile(*expression, what, source.parameters, slots, source.problems, nullptr, source.owner);
  if (expression->is_truth || slots > 0) {
    source.problems.error(
        rest.place(),
        what + " must be " + (is_of_bend ? "an angle" : "a length") + ", got a comparison",
        std::string("rest: keep, here, or an expression such as ") +
            (is_of_bend ? "rest_rad + 0.1 * bend_rad" : "rest_m + elongation_m"));
  } else if (compiled) {
    exit.rest = engine::RestRule::kExpression;
    exit.rest_length = std::move(compiled->program);
  }
}

Transition read_exit(config::MappingReader& reader, const ExitSource& source,
                     std::uint32_t& next_slot) {
  Transition exit;
  const std::string target_name = reader.required_choice("to", source.states);
  const auto target = std::find(source.states.begin(), source.states.end(), target_name);
  exit.target = static_cast<std::uint32_t>(target - source.states.begin());
  const Value when = reader.required_value("when");
  const std::string what = "'when' in " + reader.what();
  if (when.exists()) {
    const std::optional<Expression> condition = parse_expression(when, what, source.problems);
    std::optional<CompiledExpression> compiled;
    if (condition)
      compiled = compile(*condition, what, source.parameters, next_slot, source.problems,
                         &source.outside, source.owner);
    if (compiled && !condition->is_truth) {
      source.problems.error(when.place(), what + " must be a condition, got a number",
                            "compare it: " + when.text() + " > 0");
    } else if (compiled) {
      exit.when = std::move(compiled->program);
      if (compiled->first != engine::Quantity::kNone) exit.triggered = compiled->first;
    }
  }
  read_rest(reader, source, exit);
  reader.finish();
  return exit;
}

/// Friction, and the formulas that its coefficients follow.
struct FrictionRead {
  engine::Friction friction;
  std::vector<engine::ParameterFormula> formulas;
};

/// A formula of one value.
engine::Program constant(double value) {
  engine::Program program;
  program.code.push_back({engine::Operation::kConstant, engine::Quantity::kDistance, value, 0});
  return program;
}

/// Puts two coefficients where they belong. What follows a formula is 0 as a number, and so is what stands
/// beside it.
void put_coefficients(const ChangingNumber& sticking, const ChangingNumber& sliding,
                      FrictionRead& read) {
  read.friction.static_coefficient = sticking.number;
  read.friction.kinetic_coefficient = sliding.number;
  if (sticking.changes()) {
    read.friction.kinetic_coefficient = 0.0;
    read.formulas.push_back({engine::Parameter::kStaticFriction, sticking.program});
  }
  if (sliding.changes()) {
    read.formulas.push_back({engine::Parameter::kKineticFriction, sliding.program});
  } else if (sticking.changes()) {
    read.formulas.push_back({engine::Parameter::kKineticFriction, constant(sliding.number)});
  }
}

/// The key `friction`. @param before  whose stiffness and viscosity count unless it gives its own
FrictionRead read_friction(config::MappingReader& owner, const engine::Friction& before,
                           const ParameterValues& parameters, AskedOutside& outside,
                           Problems& problems) {
  FrictionRead read;
  engine::Friction& friction = read.friction;
  const Value value = owner.optional_mapping("friction");
  if (!value.exists()) return read;
  config::MappingReader reader(value, "friction of " + owner.what(), problems);
  const Range not_negative = Range::not_negative();
  reader.required_value("static", std::string("for example ") + kExampleOfFriction);
  const ChangingNumber sticking =
      optional_changing(reader, "static", 0.0, not_negative, parameters, outside, problems);
  const ChangingNumber written =
      optional_changing(reader, "kinetic", 0.0, not_negative, parameters, outside, problems);
  const ChangingNumber& sliding = reader.has("kinetic") ? written : sticking;
  put_coefficients(sticking, sliding, read);
  friction.stiffness =
      before.acts()
          ? optional_formula(reader, "stiffness_n_per_m", before.stiffness, Range::positive(),
                             parameters, problems)
          : required_formula(reader, "stiffness_n_per_m", Range::positive(), parameters, problems);
  friction.viscosity = optional_formula(reader, "viscosity_n_s_per_m", before.viscosity,
                                        Range::between(0.0, kMaxViscosity), parameters, problems);
  const bool are_numbers = reader.has("static") && !sticking.changes() && !sliding.changes();
  if (are_numbers && sliding.number > sticking.number) {
    reader.error_at("kinetic", "'kinetic' in " + reader.what() + " must not be above 'static'");
  }
  reader.finish();
  return read;
}

/// Adds formulas to those of a state.
void add_formulas(const std::vector<engine::ParameterFormula>& formulas, LinkState& state) {
  state.formulas.insert(state.formulas.end(), formulas.begin(), formulas.end());
}

/// The key `friction` of a state: a mapping, or `none`.
void read_own_friction(config::MappingReader& reader, const FrictionRead& of_liaison,
                       const ExitSource& source, LinkState& state) {
  reader.describe(
      {.key = "friction", .kind = config::KeyKind::kMappingOrWord, .choices = {"none"}});
  const Value value = reader.optional_value("friction");
  if (!value.exists()) {
    add_formulas(of_liaison.formulas, state);
  } else if (value.text() == "none") {
    state.friction = engine::Friction{};
  } else {
    const FrictionRead own = read_friction(reader, of_liaison.friction, source.parameters,
                                           source.outside, source.problems);
    state.friction = own.friction;
    add_formulas(own.formulas, state);
  }
}

void read_state(const Value::Entry& entry, const std::string& liaison, const ExitSource& source,
                const FrictionRead& friction, engine::StateMachine& state_machine,
                StateMachinePlaces& places) {
  const std::string what = "state '" + entry.key + "' of " + liaison;
  config::MappingReader reader(entry.value, what, source.problems);
  if (!is_free_name(entry.key)) {
    source.problems.error(entry.key_place, "'" + entry.key + "' cannot be the name of a state");
  }
  const bool is_of_bend = source.owner == ExpressionOwner::kBend;
  LinkState state =
      is_of_bend ? state_of(read_bend_parameters(reader, source.space,
                                                 /*needs_stiffness=*/false, source.parameters,
                                                 source.outside, source.problems))
                 : read_physics(reader, source.parameters, source.outside, source.problems);
  state.name = entry.key;
  if (!is_of_bend) read_own_friction(reader, friction, source, state);
  state.first_exit = static_cast<std::uint32_t>(state_machine.exits.size());
  std::uint32_t next_slot = 0;
  const Value exits = reader.optional_sequence("exits");
  if (state_machine.exits.size() + exits.items().size() > kMaxExits) {
    reader.error_at("exits", liaison + " has more than " + std::to_string(kMaxExits) + " exits");
    return;
  }
  for (const Value& exit : exits.items()) {
    config::MappingReader exit_reader(exit, "exit of " + what, source.problems);
    state_machine.exits.push_back(read_exit(exit_reader, source, next_slot));
    places.exits.push_back(exit_reader.place_of("when"));
    places.rests.push_back(exit_reader.place_of("rest"));
  }
  state.last_exit = static_cast<std::uint32_t>(state_machine.exits.size());
  places.states.push_back({entry.key_place, reader.optional_truth("final", false)});
  reader.finish();
  state_machine.states.push_back(std::move(state));
}

/// `slip_m` without friction is always 0.
void check_slip(const engine::StateMachine& state_machine, const StateMachinePlaces& places,
                const std::string& liaison, Problems& problems) {
  if (rubs(state_machine)) return;
  for (std::size_t e = 0; e < state_machine.exits.size(); ++e) {
    const engine::Transition& exit = state_machine.exits[e];
    const bool in_condition = asks_for(exit.when, engine::Quantity::kSlid);
    if (!in_condition && !asks_for(exit.rest_length, engine::Quantity::kSlid)) continue;
    problems.error(in_condition ? places.exits[e] : places.rests[e],
                   (in_condition ? "a condition of " : "a rest length of ") + liaison +
                       " asks for 'slip_m', which has no friction",
                   "give it 'friction', or ask for slip_m_per_s");
  }
}

/// `states` and `start`. @param space_of_bend  dimensions; nothing: they are those of links
/// @param friction  of the liaison
void read_states(config::MappingReader& reader, std::optional<int> space_of_bend,
                 const FrictionRead& friction, const ParameterValues& parameters,
                 AskedOutside& outside, engine::StateMachine& state_machine,
                 StateMachinePlaces& places, Problems& problems) {
  const Value states = reader.optional_mapping("states");
  std::vector<std::string> names;
  for (const Value::Entry& entry : states.entries()) names.push_back(entry.key);
  if (states.exists() && names.empty())
    reader.error_at("states", "'states' in " + reader.what() + " must not be empty");
  if (names.size() > engine::kMaxStates) {
    reader.error_at("states", "'states' in " + reader.what() + " has more than " +
                                  std::to_string(engine::kMaxStates) + " states");
  }
  if (names.empty() || names.size() > engine::kMaxStates) {
    reader.optional_value("start");
    return;
  }
  const std::string start = reader.optional_choice("start", names.front(), names);
  state_machine.start =
      static_cast<std::uint32_t>(std::find(names.begin(), names.end(), start) - names.begin());
  const ExitSource source{parameters,
                          names,
                          outside,
                          problems,
                          space_of_bend ? ExpressionOwner::kBend : ExpressionOwner::kLink,
                          space_of_bend.value_or(0)};
  for (const Value::Entry& entry : states.entries())
    read_state(entry, reader.what(), source, friction, state_machine, places);
}

constexpr std::array<const char*, 7> kSignsOfStateMachine{
    {"states", "elasticity", "dissipation", "force_limit_n", "pulls", "pushes", "friction"}};

}  // namespace

bool looks_like_state_machine(const Value& liaison) {
  return std::any_of(kSignsOfStateMachine.begin(), kSignsOfStateMachine.end(),
                     [&](const char* key) { return liaison.find(key).exists(); });
}

engine::StateMachine read_state_machine(config::MappingReader& reader,
                                        const ParameterValues& parameters, AskedOutside& outside,
                                        StateMachinePlaces& places, Problems& problems) {
  engine::StateMachine state_machine;
  const FrictionRead friction = read_friction(reader, {}, parameters, outside, problems);
  state_machine.friction = friction.friction;
  if (!reader.has("states")) {
    state_machine.states.push_back(read_physics(reader, parameters, outside, problems));
    add_formulas(friction.formulas, state_machine.states.back());
    places.states.push_back({reader.place(), true});
    reader.optional_value("states");
    return state_machine;
  }
  read_states(reader, std::nullopt, friction, parameters, outside, state_machine, places, problems);
  check_slip(state_machine, places, reader.what(), problems);
  return state_machine;
}

engine::StateMachine read_bend_states(config::MappingReader& reader, int space,
                                      const ParameterValues& parameters, AskedOutside& outside,
                                      StateMachinePlaces& places, Problems& problems) {
  engine::StateMachine state_machine;
  read_states(reader, space, {}, parameters, outside, state_machine, places, problems);
  return state_machine;
}

}  // namespace cordis::scene
