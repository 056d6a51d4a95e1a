// sim_node/engine/links/state_table.cpp
#include "sim_node/engine/links/state_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/laws/nearest_zero.h"
#include "sim_node/engine/laws/quadrature.h"
#include "sim_node/engine/laws/scalar_tension.h"

namespace cordis::engine {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
static_assert(static_cast<int>(RestCode::kKeep) == static_cast<int>(RestRule::kKeep) &&
              static_cast<int>(RestCode::kHere) == static_cast<int>(RestRule::kHere) &&
              static_cast<int>(RestCode::kExpression) == static_cast<int>(RestRule::kExpression));

/// True if check_state_machine has nothing against any of them.
bool all_pass(const std::vector<StateMachine>& state_machines,
              std::size_t variable_count) noexcept {
  try {
    for (const StateMachine& state_machine : state_machines) {
      check_state_machine(state_machine, "state machine", variable_count);
    }
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

ProgramTerm ready(const Program& program, const double* variables = nullptr) {
  return {program.code.data(), program.code.size(), variables};
}

/// The integral of the tension of a spring within the limits of a state [J].
double energy_of_limited_spring(const StateTerm& term, double stiffness,
                                double elongation) noexcept {
  const double whole = stiffness * elongation;
  const double limited = std::min(term.max_tension, std::max(term.min_tension, whole));
  if (limited == whole) return 0.5 * whole * elongation;
  return limited * (elongation - 0.5 * limited / stiffness);
}

/// True for a law that pulls what is longer and pushes what is shorter: what it stores is clamped as its
/// elongation is.
bool clamps_with_elongation(const Law& law) noexcept {
  if (is_none(law)) return true;
  if (const auto* power = std::get_if<Power>(&law)) return power->coefficient >= 0.0;
  const auto* table = std::get_if<Table>(&law);
  if (table == nullptr || elastic_tension(law, LawPoint{}) != 0.0) return false;
  for (std::size_t i = 0; i < table->argument().size(); ++i) {
    if (table->argument()[i] * table->value()[i] < 0.0) return false;
  }
  return true;
}

/// What Lennard-Jones stores that only pulls, or only pushes [J].
double energy_of_half(const LennardJones& balls, bool pulls, double distance) noexcept {
  const double of_no_force = std::pow(2.0, 1.0 / 6.0) * balls.diameter;
  const double lowest = balls.cutoff > 0.0 ? std::min(of_no_force, balls.cutoff) : of_no_force;
  const double away = std::abs(distance);
  if (pulls) return balls.potential(std::max(away, lowest), 0.0);
  return balls.potential(std::min(away, lowest), 0.0) - balls.potential(lowest, 0.0);
}

/// From where the energy of a law is integrated that has a limit [m]: there it is within the limit.
/// Ends that meet in 1 dimension pass each other: what rings store counts from one side on both.
double begin_of_integral(const Law& law, const LawPoint& link) noexcept {
  if (const auto* expression = std::get_if<Expression>(&law))
    return expression->distance_of_no_potential(link);
  if (argument_of(law) != LawArgument::kDistance) return link.distance - link.elongation;
  const double range = range_of(law);
  const auto* balls = std::get_if<LennardJones>(&law);
  if (balls == nullptr) return range;
  const double of_no_force = std::pow(2.0, 1.0 / 6.0) * balls->diameter;
  return std::copysign(range == 0.0 ? of_no_force : range, link.distance);
}

}  // namespace

/// A LawTerm and what it points to.
struct ReadyLaw {
  LawTerm term;
  std::shared_ptr<const void> owner;
};

namespace {

/// Precondition: the law and the variables live as long as what is made of it.
ReadyLaw ready(const Law& law, const double* variables) {
  const auto* expression = std::get_if<Expression>(&law);
  const bool asks_speed = expression != nullptr && !expression->is_potential();
  const auto term_of = [variables](const auto& alternative) {
    if constexpr (requires { alternative.term(variables); }) return alternative.term(variables);
    if constexpr (!requires { alternative.term(variables); }) return alternative.term();
  };
  const auto make = [&](const auto& alternative) -> ReadyLaw {
    const auto term = std::make_shared<const decltype(alternative.term())>(term_of(alternative));
    return {{static_cast<std::uint32_t>(law.index()), alternative.kStoresEnergy, asks_speed,
             term.get()},
            term};
  };
  return std::visit(make, law);
}

}  // namespace

/// The elastic part of a state at some values of the variables.
struct StateTable::Elastic {
  const StateTerm& term;
  const LinkState& state;
  double stiffness;   // [N/m]
  bool has_law;       // beside that stiffness
  double well_depth;  // of Lennard-Jones [J]

  std::optional<LennardJones> balls() const noexcept;
  double tension_of_law(const LawPoint& link) const noexcept;
  double potential_of_law(const LawPoint& link) const noexcept;
  double whole_tension(const LawPoint& link) const noexcept;
  double tension(const LawPoint& link) const noexcept;
  double energy(const LawPoint& link) const noexcept;
  double limited_energy(const LawPoint& link) const noexcept;
};

struct StateTable::Content {
  /// A state whose parameters follow variables, and what they are now and were before.
  struct Following {
    StateIndex state = 0;
    std::size_t stiffness_size = 0;  // of the factors: Expression::factor_size()
    std::size_t viscosity_size = 0;
    double stiffness = 0.0;  // that factor
    double stiffness_before = 0.0;
    double viscosity = 0.0;
    double well_depth = 0.0;  // of Lennard-Jones [J]
    double well_depth_before = 0.0;
    std::optional<double> rest_angle{};
    double static_friction = 0.0;
    double kinetic_friction = 0.0;
  };

  std::vector<StateMachine> state_machines;
  double dt = 0.0;
  double part_of_work = 0.5;  // that the account has not entered yet
  std::vector<StateTerm> terms;
  std::vector<std::vector<TransitionTerm>> exits;  // by state machine
  std::vector<ReadyLaw> laws;  // of all terms, in order: elasticity, dissipation
  std::vector<std::unique_ptr<LennardJones::Term>> depths;  // of laws whose depth follows, in order
  std::vector<StateIndex> first_state;                      // by state machine
  std::vector<std::uint32_t> state_machine_of;              // by state
  std::array<bool, kQuantityCount> needs{};
  std::uint32_t slot_count = 0;
  std::vector<double> variables;  // of as many as the network has; stays where it is
  std::vector<double> variables_before;
  std::vector<bool> asks_for_variable;  // by state, and of the padding
  std::vector<Following> following;
  std::vector<std::uint32_t> following_of;  // by state, and of the padding: its place, or kNone
  std::vector<Program> watched;             // parts of formulas of variables

  static constexpr std::uint32_t kNone = 0xffffffffU;

  void build();
  const LinkState& state(StateIndex index) const noexcept {
    const std::uint32_t machine = state_machine_of[index];
    return state_machines[machine].states[index - first_state[machine]];
  }
  const Following* following_in(StateIndex index) const noexcept {
    const std::uint32_t place = following_of[index];
    return place == kNone ? nullptr : &following[place];
  }
  double value_of_formula(const LinkState& state, Parameter parameter) const noexcept;
  void find(Following& parameters) noexcept;
  /// @param before  as the variables were kept
  Elastic elastic_in(StateIndex index, bool before) const noexcept;
  void add_following(const LinkState& state, StateIndex index);
  void add_state_machine(const StateMachine& state_machine);
  void add_state(const LinkState& state, const std::vector<TransitionTerm>& exits_of_state_machine);
  void record_needs(const Program& program);
  void watch(const Program& formula);
};

void StateTable::Content::build() {
  terms.clear();
  exits.clear();
  laws.clear();
  first_state.clear();
  state_machine_of.clear();
  asks_for_variable.clear();
  depths.clear();
  following.clear();
  following_of.clear();
  watched.clear();
  needs.fill(false);
  slot_count = 0;
  for (const StateMachine& state_machine : state_machines) add_state_machine(state_machine);
  terms.emplace_back();  // the padding
  asks_for_variable.push_back(false);
  following_of.push_back(kNone);
  for (Following& each : following) {
    find(each);
    each.stiffness_before = each.stiffness;
    each.well_depth_before = each.well_depth;
  }
}

void StateTable::Content::add_following(const LinkState& state, StateIndex index) {
  Following parameters;
  parameters.state = index;
  const auto* elastic = std::get_if<Expression>(&state.elasticity);
  const auto* viscous = std::get_if<Expression>(&state.dissipation);
  if (elastic != nullptr) parameters.stiffness_size = elastic->factor_size(Quantity::kElongation);
  if (viscous != nullptr) parameters.viscosity_size = viscous->factor_size(Quantity::kSpeed);
  const bool follows =
      parameters.stiffness_size + parameters.viscosity_size > 0 || !state.formulas.empty();
  following_of.push_back(follows ? static_cast<std::uint32_t>(following.size()) : kNone);
  if (follows) following.push_back(parameters);
}

/// 0 for what is not finite or below 0.
double StateTable::Content::value_of_formula(const LinkState& state,
                                             Parameter parameter) const noexcept {
  const Program* const formula = formula_of(state, parameter);
  if (formula == nullptr) return 0.0;
  const double value = value_of({formula->code.data(), formula->code.size(), variables.data()});
  return std::isfinite(value) ? std::max(value, 0.0) : 0.0;
}

void StateTable::Content::find(Following& parameters) noexcept {
  const LinkState& described = state(parameters.state);
  const double* const values = variables.data();
  if (parameters.stiffness_size > 0)
    parameters.stiffness =
        std::get<Expression>(described.elasticity).factor(parameters.stiffness_size, values);
  if (parameters.viscosity_size > 0)
    parameters.viscosity =
        std::get<Expression>(described.dissipation).factor(parameters.viscosity_size, values);
  if (const Program* const rest = formula_of(described, Parameter::kRestAngle)) {
    const double angle = value_of({rest->code.data(), rest->code.size(), values});
    parameters.rest_angle = std::isfinite(angle) ? std::optional(angle) : std::nullopt;
  }
  parameters.static_friction = value_of_formula(described, Parameter::kStaticFriction);
  parameters.kinetic_friction = value_of_formula(described, Parameter::kKineticFriction);
  if (formula_of(described, Parameter::kDepth) == nullptr) return;
  parameters.well_depth = value_of_formula(described, Parameter::kDepth);
  const std::size_t place = following_of[parameters.state];
  CORDIS_ASSERT(depths[place] != nullptr);
  LennardJones law = std::get<LennardJones>(described.elasticity);
  law.well_depth = parameters.well_depth;
  *depths[place] = law.term();
}

StateTable::Elastic StateTable::Content::elastic_in(StateIndex index, bool before) const noexcept {
  const LinkState& described = state(index);
  const auto* balls = std::get_if<LennardJones>(&described.elasticity);
  Elastic elastic{terms[index], described, described.stiffness, !is_none(described.elasticity),
                  balls != nullptr ? balls->well_depth : 0.0};
  const Following* const parameters = following_in(index);
  if (parameters == nullptr) return elastic;
  if (parameters->stiffness_size > 0) {
    elastic.stiffness += before ? parameters->stiffness_before : parameters->stiffness;
    elastic.has_law = false;
  }
  if (formula_of(described, Parameter::kDepth) != nullptr)
    elastic.well_depth = before ? parameters->well_depth_before : parameters->well_depth;
  return elastic;
}

void StateTable::Content::add_state_machine(const StateMachine& state_machine) {
  const auto first = static_cast<StateIndex>(terms.size());
  std::vector<TransitionTerm> exits_of_state_machine;
  for (const Transition& exit : state_machine.exits) {
    record_needs(exit.when);
    record_needs(exit.rest_length);
    if (exit.triggered != Quantity::kNone) needs[static_cast<std::size_t>(exit.triggered)] = true;
    exits_of_state_machine.push_back({ready(exit.when, variables.data()), ready(exit.rest_length),
                                      static_cast<RestCode>(exit.rest), first + exit.target,
                                      exit.triggered});
  }
  exits.push_back(std::move(exits_of_state_machine));
  first_state.push_back(first);
  for (const LinkState& state : state_machine.states) {
    for (const Law* law : {&state.elasticity, &state.dissipation}) {
      const auto* expression = std::get_if<Expression>(law);
      if (expression == nullptr) continue;
      record_needs(expression->program);
      watch(expression->program);
    }
    for (const ParameterFormula& each : state.formulas) watch(each.formula);
    state_machine_of.push_back(static_cast<std::uint32_t>(first_state.size() - 1));
    add_state(state, exits.back());
  }
}

void StateTable::Content::add_state(const LinkState& state,
                                    const std::vector<TransitionTerm>& exits_of_state_machine) {
  StateTerm term;
  term.stiffness = state.stiffness;
  term.viscosity_over_dt = state.viscosity / dt;
  term.min_tension = state.pushes ? -state.force_limit : 0.0;
  term.max_tension = state.pulls ? state.force_limit : 0.0;
  term.min_elongation = state.pushes ? -kUnlimited : 0.0;
  term.max_elongation = state.pulls ? kUnlimited : 0.0;
  term.one_sided = !(state.pulls && state.pushes);
  term.limited = term.one_sided || state.force_limit < kUnlimited;
  const auto index = static_cast<StateIndex>(terms.size());
  add_following(state, index);
  for (LawTerm* target : {&term.elasticity, &term.dissipation}) {
    laws.push_back(
        ready(target == &term.elasticity ? state.elasticity : state.dissipation, variables.data()));
    *target = laws.back().term;
  }
  if (following_of[index] != kNone) {
    depths.push_back(nullptr);
    if (formula_of(state, Parameter::kDepth) != nullptr) {
      depths.back() =
          std::make_unique<LennardJones::Term>(std::get<LennardJones>(state.elasticity).term());
      term.elasticity.term = depths.back().get();
    }
  }
  term.limits_elastic = state.force_limit < kUnlimited ||
                        (term.one_sided && !clamps_with_elongation(state.elasticity));
  term.exits = exits_of_state_machine.data() + state.first_exit;
  term.exit_count = state.last_exit - state.first_exit;
  terms.push_back(term);
  asks_for_variable.push_back(engine::asks_for_variable(state.elasticity) ||
                              formula_of(state, Parameter::kRestAngle) != nullptr ||
                              formula_of(state, Parameter::kDepth) != nullptr);
}

void StateTable::Content::watch(const Program& formula) {
  for (Program& part : parts_that_may_fail(formula)) watched.push_back(std::move(part));
}

void StateTable::Content::record_needs(const Program& program) {
  for (const Instruction& instruction : program.code) {
    if (instruction.operation == Operation::kQuantity) {
      needs[static_cast<std::size_t>(instruction.quantity)] = true;
    }
    if (instruction.operation == Operation::kRising ||
        instruction.operation == Operation::kFalling) {
      slot_count = std::max(slot_count, instruction.slot + 1);
    }
  }
}

StateTable::StateTable(std::vector<StateMachine> state_machines, double dt, bool whole_steps,
                       std::size_t variable_count)
    : content_(std::make_unique<Content>()) {
  CORDIS_ASSERT(dt > 0.0 && all_pass(state_machines, variable_count));
  content_->variables.resize(variable_count, 0.0);
  content_->variables_before.resize(variable_count, 0.0);
  content_->state_machines = std::move(state_machines);
  content_->dt = dt;
  content_->part_of_work = whole_steps ? 0.0 : 0.5;
  content_->build();
}

StateTable::~StateTable() = default;
StateTable::StateTable(StateTable&&) noexcept = default;
StateTable& StateTable::operator=(StateTable&&) noexcept = default;

const StateTerm* StateTable::terms() const noexcept {
  return content_->terms.data();
}

std::span<double> StateTable::variables() noexcept {
  return content_->variables;
}

std::span<const double> StateTable::variables() const noexcept {
  return content_->variables;
}

std::span<const double> StateTable::variables_before() const noexcept {
  return content_->variables_before;
}

void StateTable::keep_variables() noexcept {
  std::ranges::copy(content_->variables, content_->variables_before.begin());
  for (Content::Following& each : content_->following) {
    each.stiffness_before = each.stiffness;
    each.well_depth_before = each.well_depth;
  }
}

void StateTable::find_parameters() noexcept {
  for (Content::Following& each : content_->following) content_->find(each);
}

std::uint32_t StateTable::failed_parameters() const noexcept {
  const double* const values = content_->variables.data();
  std::uint32_t failed = 0;
  for (const Program& part : content_->watched) {
    if (!std::isfinite(value_of({part.code.data(), part.code.size(), values}))) ++failed;
  }
  return failed;
}

double StateTable::stiffness(StateIndex state) const noexcept {
  const double own = content_->terms[state].stiffness;
  const Content::Following* const parameters = content_->following_in(state);
  return parameters == nullptr ? own : own + parameters->stiffness;
}

double StateTable::viscosity(StateIndex index) const noexcept {
  const Content::Following* const parameters = content_->following_in(index);
  const double own = state(index).viscosity;
  return parameters == nullptr ? own : own + parameters->viscosity;
}

double StateTable::stiffness_before(StateIndex state) const noexcept {
  const double own = content_->terms[state].stiffness;
  const Content::Following* const parameters = content_->following_in(state);
  return parameters == nullptr ? own : own + parameters->stiffness_before;
}

double StateTable::dt() const noexcept {
  return content_->dt;
}

std::optional<double> StateTable::rest_angle(StateIndex state) const noexcept {
  const Content::Following* const parameters = content_->following_in(state);
  return parameters == nullptr ? std::nullopt : parameters->rest_angle;
}

Friction StateTable::friction(StateIndex index) const noexcept {
  const std::uint32_t machine = state_machine_of(index);
  Friction friction = friction_in(content_->state_machines[machine], index - first_state(machine));
  if (!friction_follows(index)) return friction;
  const Content::Following& parameters = *content_->following_in(index);
  if (formula_of(state(index), Parameter::kStaticFriction) != nullptr)
    friction.static_coefficient = parameters.static_friction;
  if (formula_of(state(index), Parameter::kKineticFriction) != nullptr)
    friction.kinetic_coefficient = parameters.kinetic_friction;
  friction.kinetic_coefficient =
      std::min(friction.kinetic_coefficient, friction.static_coefficient);
  return friction;
}

bool StateTable::friction_follows(StateIndex index) const noexcept {
  const LinkState& described = state(index);
  return formula_of(described, Parameter::kStaticFriction) != nullptr ||
         formula_of(described, Parameter::kKineticFriction) != nullptr;
}

bool StateTable::is_linear(StateIndex index) const noexcept {
  const LinkState& described = state(index);
  return (is_none(described.elasticity) ||
          is_product(described.elasticity, Quantity::kElongation)) &&
         (is_none(described.dissipation) || is_product(described.dissipation, Quantity::kSpeed));
}

bool StateTable::asks_for_variable(StateIndex state) const noexcept {
  return content_->asks_for_variable[state];
}

std::size_t StateTable::state_count() const noexcept {
  return content_->state_machine_of.size();
}

StateIndex StateTable::padding_state() const noexcept {
  return static_cast<StateIndex>(state_count());
}

StateIndex StateTable::first_state(std::uint32_t state_machine) const noexcept {
  return content_->first_state[state_machine];
}

StateIndex StateTable::start_state(std::uint32_t state_machine) const noexcept {
  return first_state(state_machine) + content_->state_machines[state_machine].start;
}

std::uint32_t StateTable::state_machine_of(StateIndex state) const noexcept {
  return content_->state_machine_of[state];
}

const std::vector<StateMachine>& StateTable::state_machines() const noexcept {
  return content_->state_machines;
}

const LinkState& StateTable::state(StateIndex state) const noexcept {
  return content_->state(state);
}

bool StateTable::needs(Quantity quantity) const noexcept {
  return content_->needs[static_cast<std::size_t>(quantity)];
}

std::uint32_t StateTable::slot_count() const noexcept {
  return content_->slot_count;
}

double StateTable::stored_energy(StateIndex index, double distance, double rest_length,
                                 const EndMasses& mass) const noexcept {
  return content_->elastic_in(index, false)
      .energy({distance, distance - rest_length, 0.0, mass.a, mass.b, content_->variables.data()});
}

/// Lennard-Jones as it is now, with its depth; nothing where the law is another.
std::optional<LennardJones> StateTable::Elastic::balls() const noexcept {
  const auto* law = std::get_if<LennardJones>(&state.elasticity);
  if (law == nullptr) return std::nullopt;
  LennardJones balls = *law;
  balls.well_depth = well_depth;
  return balls;
}

double StateTable::Elastic::tension_of_law(const LawPoint& link) const noexcept {
  if (const auto law = balls()) return scalar_tension(*law, link, link.elongation);
  return elastic_tension(state.elasticity, link);
}

double StateTable::Elastic::potential_of_law(const LawPoint& link) const noexcept {
  if (const auto law = balls()) return law->potential(link.distance, link.elongation);
  return potential(state.elasticity, link);
}

double StateTable::Elastic::energy(const LawPoint& link) const noexcept {
  if (!has_law && term.limits_elastic)
    return energy_of_limited_spring(term, stiffness, link.elongation);
  if (term.limits_elastic) return limited_energy(link);
  LawPoint clamped = link;
  clamped.elongation =
      std::min(term.max_elongation, std::max(term.min_elongation, link.elongation));
  const double linear = 0.5 * stiffness * clamped.elongation * clamped.elongation;
  return has_law ? linear + potential_of_law(clamped) : linear;
}

/// The tension that stores energy, without the limits of the state [N].
double StateTable::Elastic::whole_tension(const LawPoint& link) const noexcept {
  const double linear = stiffness * link.elongation;
  return has_law ? linear + tension_of_law(link) : linear;
}

/// Likewise within them [N].
double StateTable::Elastic::tension(const LawPoint& link) const noexcept {
  if (term.limits_elastic)
    return std::min(term.max_tension, std::max(term.min_tension, whole_tension(link)));
  if (has_law) return whole_tension(link);
  return stiffness * std::min(term.max_elongation, std::max(term.min_elongation, link.elongation));
}

double StateTable::parameter_energy(StateIndex index, double distance, double rest_length,
                                    const EndMasses& mass,
                                    double elongation_increment) const noexcept {
  // In the middle of the last period, for every integrator: a parameter changes all the time, and at the end of
  // each period its work would be wrong by a part of order dt.
  const auto energy = [&](bool before) {
    const std::vector<double>& variables =
        before ? content_->variables_before : content_->variables;
    const LawPoint link{distance, distance - rest_length, 0.0, mass.a, mass.b, variables.data()};
    const Elastic elastic = content_->elastic_in(index, before);
    return elastic.energy(link) - 0.5 * elastic.tension(link) * elongation_increment;
  };
  return energy(false) - energy(true);
}

/// Energy of a state whose tension has limits: the integral of the limited elastic tension [J].
double StateTable::Elastic::limited_energy(const LawPoint& link) const noexcept {
  const bool is_limited = std::isfinite(state.force_limit);
  // A distance below 0, in 1 dimension, has a tension of the other sign.
  const bool pulls = link.distance < 0.0 ? term.min_tension < 0.0 : term.max_tension > 0.0;
  if (const auto law = balls();
      law && stiffness == 0.0 && term.one_sided && !is_limited && (state.pulls || state.pushes)) {
    return energy_of_half(*law, pulls, link.distance);
  }
  const double rest_length = link.distance - link.elongation;
  const auto point_at = [&](double distance) {
    return LawPoint{distance,    distance - rest_length, 0.0, link.mass_a,
                    link.mass_b, link.variables};
  };
  const auto whole = [&](double distance) { return whole_tension(point_at(distance)); };
  const auto limited = [&](double distance) { return tension(point_at(distance)); };
  const double begin = begin_of_integral(state.elasticity, link);
  const bool is_of_distance = argument_of(state.elasticity) == LawArgument::kDistance;
  double at_begin = energy_of_limited_spring(term, stiffness, begin - rest_length);
  if (is_of_distance && pulls)
    at_begin += potential_of_law({begin});  // else no force takes it away
  // A side ends where the tension vanishes, and beyond the range of a law where the spring has its rest length: the
  // rule cannot see a corner near an end.
  const auto passes = [&](double place) { return (place - begin) * (place - link.distance) < 0.0; };
  double corner = passes(rest_length) ? rest_length : begin;
  if (std::holds_alternative<Expression>(state.elasticity)) {
    const std::optional<double> zero = nearest_zero(whole, link.distance);
    if (zero && passes(*zero)) corner = *zero;
  }
  return at_begin + integral_over_distance(limited, begin, corner) +
         integral_over_distance(limited, corner, link.distance);
}

double StateTable::change_energy(const StateMachineRows& rows, std::size_t row) const noexcept {
  const double part = content_->part_of_work;
  const double distance = rows.quantity[static_cast<std::size_t>(Quantity::kDistance)][row];
  const auto mass_of = [&](Quantity end) {
    const double* masses = rows.quantity[static_cast<std::size_t>(end)];
    return masses == nullptr ? 0.0 : masses[row];
  };
  const EndMasses mass{mass_of(Quantity::kMassA), mass_of(Quantity::kMassB)};
  const double after = stored_energy(rows.state[row], distance, rows.rest_length[row], mass) -
                       part * rows.elastic[row] * rows.elongation_increment[row];
  const double before = stored_energy(rows.from[row], distance, rows.rest_before[row], mass) -
                        part * rows.elastic_before[row] * rows.elongation_increment[row];
  return after - before;
}

Quantity StateTable::triggered(StateIndex from, std::uint32_t exit) const noexcept {
  return exit == kNotForced ? Quantity::kNone : content_->terms[from].exits[exit].triggered;
}

bool StateTable::keeps_rest(StateIndex from, std::uint32_t exit) const noexcept {
  return exit == kNotForced || content_->terms[from].exits[exit].rest == RestCode::kKeep;
}

double StateTable::part_of_work() const noexcept {
  return content_->part_of_work;
}

void StateTable::replace(std::uint32_t index, const StateMachine& state_machine) {
  CORDIS_ASSERT(index < content_->state_machines.size() &&
                state_machine.states.size() == content_->state_machines[index].states.size() &&
                all_pass({state_machine}, content_->variables.size()));
  content_->state_machines[index] = state_machine;
  content_->build();
}

}  // namespace cordis::engine
