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

/// The integral of the tension of a spring within its limits [J].
double energy_of_limited_spring(const StateTerm& term, double elongation) noexcept {
  const double whole = term.stiffness * elongation;
  const double limited = std::min(term.max_tension, std::max(term.min_tension, whole));
  if (limited == whole) return 0.5 * whole * elongation;
  return limited * (elongation - 0.5 * limited / term.stiffness);
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

struct StateTable::Content {
  std::vector<StateMachine> state_machines;
  double dt = 0.0;
  double part_of_work = 0.5;  // that the account has not entered yet
  std::vector<StateTerm> terms;
  std::vector<std::vector<TransitionTerm>> exits;  // by state machine
  std::vector<ReadyLaw> laws;                   // of all terms, in order: elasticity, dissipation
  std::vector<StateIndex> first_state;          // by state machine
  std::vector<std::uint32_t> state_machine_of;  // by state
  std::array<bool, kQuantityCount> needs{};
  std::uint32_t slot_count = 0;
  std::vector<double> variables;  // of as many as the network has; stays where it is
  std::vector<double> variables_before;
  std::vector<bool> asks_for_variable;  // by state, and of the padding

  void build();
  void add_state_machine(const StateMachine& state_machine);
  void add_state(const LinkState& state, const std::vector<TransitionTerm>& exits_of_state_machine);
  void record_needs(const Program& program);
};

void StateTable::Content::build() {
  terms.clear();
  exits.clear();
  laws.clear();
  first_state.clear();
  state_machine_of.clear();
  asks_for_variable.clear();
  needs.fill(false);
  slot_count = 0;
  for (const StateMachine& state_machine : state_machines) add_state_machine(state_machine);
  terms.emplace_back();  // the padding
  asks_for_variable.push_back(false);
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
      if (const auto* expression = std::get_if<Expression>(law)) record_needs(expression->program);
    }
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
  for (LawTerm* target : {&term.elasticity, &term.dissipation}) {
    laws.push_back(
        ready(target == &term.elasticity ? state.elasticity : state.dissipation, variables.data()));
    *target = laws.back().term;
  }
  term.limits_elastic = state.force_limit < kUnlimited ||
                        (term.one_sided && !clamps_with_elongation(state.elasticity));
  term.exits = exits_of_state_machine.data() + state.first_exit;
  term.exit_count = state.last_exit - state.first_exit;
  terms.push_back(term);
  asks_for_variable.push_back(engine::asks_for_variable(state.elasticity));
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

void StateTable::keep_variables() noexcept {
  std::ranges::copy(content_->variables, content_->variables_before.begin());
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
  const std::uint32_t state_machine = state_machine_of(state);
  return content_->state_machines[state_machine].states[state - first_state(state_machine)];
}

bool StateTable::needs(Quantity quantity) const noexcept {
  return content_->needs[static_cast<std::size_t>(quantity)];
}

std::uint32_t StateTable::slot_count() const noexcept {
  return content_->slot_count;
}

double StateTable::stored_energy(StateIndex index, double distance, double rest_length,
                                 const EndMasses& mass) const noexcept {
  return stored_energy(
      index, {distance, distance - rest_length, 0.0, mass.a, mass.b, content_->variables.data()});
}

double StateTable::stored_energy(StateIndex index, const LawPoint& link) const noexcept {
  const StateTerm& term = content_->terms[index];
  if (term.limits_elastic) return limited_energy(index, link);
  LawPoint clamped = link;
  clamped.elongation =
      std::min(term.max_elongation, std::max(term.min_elongation, link.elongation));
  const double linear = 0.5 * term.stiffness * clamped.elongation * clamped.elongation;
  if (term.elasticity.type == 0) return linear;
  return linear + potential(state(index).elasticity, clamped);
}

double StateTable::whole_tension(StateIndex index, const LawPoint& link) const noexcept {
  return content_->terms[index].stiffness * link.elongation +
         elastic_tension(state(index).elasticity, link);
}

double StateTable::elastic_tension_of(StateIndex index, const LawPoint& link) const noexcept {
  const StateTerm& term = content_->terms[index];
  const double whole = whole_tension(index, link);
  if (!term.limits_elastic) return whole;
  return std::min(term.max_tension, std::max(term.min_tension, whole));
}

double StateTable::parameter_energy(StateIndex index, double distance, double rest_length,
                                    const EndMasses& mass,
                                    double elongation_increment) const noexcept {
  // In the middle of the last period, for every integrator: a parameter changes all the time, and at the end of
  // each period its work would be wrong by a part of order dt.
  const auto energy = [&](const std::vector<double>& variables) {
    const LawPoint link{distance, distance - rest_length, 0.0, mass.a, mass.b, variables.data()};
    return stored_energy(index, link) -
           0.5 * elastic_tension_of(index, link) * elongation_increment;
  };
  return energy(content_->variables) - energy(content_->variables_before);
}

/// Energy of a state whose tension has limits: the integral of the limited elastic tension [J].
double StateTable::limited_energy(StateIndex index, const LawPoint& link) const noexcept {
  const StateTerm& term = content_->terms[index];
  const Law& law = state(index).elasticity;
  if (is_none(law)) return energy_of_limited_spring(term, link.elongation);
  const auto* balls = std::get_if<LennardJones>(&law);
  const bool is_limited = std::isfinite(state(index).force_limit);
  // A distance below 0, in 1 dimension, has a tension of the other sign.
  const bool pulls = link.distance < 0.0 ? term.min_tension < 0.0 : term.max_tension > 0.0;
  if (balls != nullptr && term.stiffness == 0.0 && term.one_sided && !is_limited &&
      (state(index).pulls || state(index).pushes))
    return energy_of_half(*balls, pulls, link.distance);
  const double rest_length = link.distance - link.elongation;
  const auto point_at = [&](double distance) {
    return LawPoint{distance,    distance - rest_length, 0.0, link.mass_a,
                    link.mass_b, link.variables};
  };
  const auto whole = [&](double distance) { return whole_tension(index, point_at(distance)); };
  const auto tension = [&](double distance) {
    return elastic_tension_of(index, point_at(distance));
  };
  const double begin = begin_of_integral(law, link);
  const bool is_of_distance = argument_of(law) == LawArgument::kDistance;
  double at_begin = energy_of_limited_spring(term, begin - rest_length);
  if (is_of_distance && pulls) at_begin += potential(law, {begin});  // else no force takes it away
  // A side ends where the tension vanishes, and beyond the range of a law where the spring has its rest length: the
  // rule cannot see a corner near an end.
  const auto passes = [&](double place) { return (place - begin) * (place - link.distance) < 0.0; };
  double corner = passes(rest_length) ? rest_length : begin;
  if (std::holds_alternative<Expression>(law)) {
    const std::optional<double> zero = nearest_zero(whole, link.distance);
    if (zero && passes(*zero)) corner = *zero;
  }
  return at_begin + integral_over_distance(tension, begin, corner) +
         integral_over_distance(tension, corner, link.distance);
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
