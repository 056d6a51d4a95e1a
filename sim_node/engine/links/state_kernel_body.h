// sim_node/engine/links/state_kernel_body.h -- one step of the state machines of 8 rows.
//
// The rows of a batch that are in the same state go through the exits and the law of that state
// together. The others are left as they are. A batch in one state, the common case, goes once.
#pragma once

#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/laws/law_kernel_body.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/simd/lane_batch.h"

namespace cordis::engine {

template <class Lanes>
class StateMachineLoop {
  using Row = typename Lanes::Row;
  using Batch = LaneBatch<Lanes>;

 public:
  static void step(const StateTerm* states, StateMachineRows& rows) noexcept {
    StateMachineLoop(states, rows).step();
  }

  static void find_tensions(const StateTerm& state, const PlainRows& rows) noexcept {
    alignas(64) double elongation[Batch::kRows];
    alignas(64) double elastic[Batch::kRows];
    const auto quantity = [](Quantity which) { return static_cast<std::size_t>(which); };
    StateMachineRows batch{};
    batch.rate = rows.rate;
    batch.elongation = elongation;
    batch.elastic = elastic;
    StateMachineLoop loop(&state, batch);
    const auto per_distance = [](Row tension, Row inverse) {
      const auto still = Lanes::equal(inverse, Lanes::zero());
      return Lanes::select(still, Lanes::zero(), tension * inverse);
    };
    for (std::size_t i = 0; i < rows.count; i += Batch::kRows) {
      Batch::each(
          elongation, [](Row d, Row rest) { return d - rest; }, rows.distance + i,
          rows.rest_length + i);
      batch.quantity[quantity(Quantity::kDistance)] = rows.distance + i;
      if (rows.mass_a != nullptr) {
        batch.quantity[quantity(Quantity::kMassA)] = rows.mass_a + i;
        batch.quantity[quantity(Quantity::kMassB)] = rows.mass_b + i;
      }
      loop.find_tension(state, Batch::kAll, rows.elongation_increment + i);
      Batch::each(rows.factor + i, per_distance, loop.tension_, rows.inverse + i);
      Batch::each(
          rows.viscous_factor + i,
          [&](Row tension, Row e, Row inverse) { return per_distance(tension - e, inverse); },
          loop.tension_, elastic, rows.inverse + i);
    }
  }

 private:
  StateMachineLoop(const StateTerm* states, StateMachineRows& rows) noexcept
      : states_(states), rows_(rows) {}

  void step() noexcept {
    rows_.changed = 0;
    for (std::uint32_t left = Batch::kAll; left != 0;) {
      const StateIndex state = rows_.state[__builtin_ctz(left)];
      const std::uint32_t group = rows_in(state);
      if (!rows_.frozen) test_exits(states_[state], group);
      find_tension(states_[state], group, rows_.elongation_increment);
      left &= ~group;
    }
    if (rows_.changed != 0) enter();
    finish();
  }

  /// Bit i: row i is in this state.
  std::uint32_t rows_in(StateIndex state) const noexcept {
    std::uint32_t differing = 0;
    for (std::size_t i = 0; i < Batch::kRows; ++i) differing |= rows_.state[i] ^ state;
    if (differing == 0) return Batch::kAll;
    std::uint32_t rows = 0;
    for (std::size_t i = 0; i < Batch::kRows; ++i) {
      rows |= static_cast<std::uint32_t>(rows_.state[i] == state) << i;
    }
    return rows;
  }

  /// Notes which rows leave, and where to. The programs of all exits run, so that what they
  /// remember does not depend on who leaves.
  void test_exits(const StateTerm& state, std::uint32_t group) noexcept {
    if (rows_.forced != nullptr) record_forced(group);
    for (std::uint32_t e = 0; e < state.exit_count; ++e) {
      const double* value =
          program_.evaluate(state.exits[e].when, {rows_.quantity, rows_.memory}, group);
      const std::uint32_t holding =
          Batch::bits(value, [](Row v) { return Lanes::not_equal(v, Lanes::zero()); });
      const std::uint32_t leaving = holding & group & ~rows_.changed;
      if (leaving != 0) note(state, e, leaving);
    }
  }

  void record_forced(std::uint32_t group) noexcept {
    for (std::uint32_t i = 0; i < Batch::kRows; ++i) {
      if ((group >> i & 1U) == 0 || rows_.forced[i] == kNotForced) continue;
      rows_.exit[i] = kNotForced;
      rows_.trigger_value[i] = 0.0;
      target_[i] = rows_.forced[i];
      rows_.forced[i] = kNotForced;
      rows_.changed |= 1U << i;
    }
  }

  void note(const StateTerm& state, std::uint32_t exit, std::uint32_t leaving) noexcept {
    const TransitionTerm& term = state.exits[exit];
    const double* triggered = rows_.quantity[static_cast<std::size_t>(term.triggered)];
    for (std::uint32_t i = 0; i < Batch::kRows; ++i) {
      if ((leaving >> i & 1U) == 0) continue;
      rows_.exit[i] = exit;
      rows_.trigger_value[i] = triggered[i];
      target_[i] = term.target;
    }
    rows_.changed |= leaving;
  }

  /// The tension of the rows of a group, all in one state.
  void find_tension(const StateTerm& state, std::uint32_t group,
                    const double* elongation_increment) noexcept {
    alignas(64) double tension[Batch::kRows];
    alignas(64) double elastic[Batch::kRows];
    alignas(64) double speed[Batch::kRows];
    const bool stores_energy = state.elasticity.stores_energy;
    const Row rate = Lanes::every(rows_.rate);
    const auto stretch = [&](const double* elongation, double* out) {
      const Row stiffness = Lanes::every(state.stiffness);
      Batch::each(
          out, [&](Row e) { return stiffness * e; }, elongation);
    };

    Batch::each(
        speed, [&](Row g) { return g * rate; }, elongation_increment);
    stretch(rows_.elongation, elastic);
    LawArguments law_arguments = arguments(rows_.elongation, speed);
    if (stores_energy) LawLoop<Lanes>::add(state.elasticity, law_arguments, elastic);
    const Row viscosity = Lanes::every(state.viscosity_over_dt);
    Batch::each(
        tension, [&](Row e, Row g) { return e + viscosity * g; }, elastic, elongation_increment);
    if (!stores_energy) add_expression(state.elasticity, law_arguments, tension, elastic);
    law_arguments.argument = speed;
    LawLoop<Lanes>::add(state.dissipation, law_arguments, tension);

    if (state.limited) limit(state, tension);
    if (state.limits_elastic) {
      limit(state, elastic);
    } else if (state.one_sided) {
      alignas(64) double elongation[Batch::kRows];
      const Row least = Lanes::every(state.min_elongation);
      const Row most = Lanes::every(state.max_elongation);
      Batch::each(
          elongation, [&](Row e) { return Lanes::minimum(most, Lanes::maximum(least, e)); },
          rows_.elongation);
      stretch(elongation, elastic);
      if (stores_energy) {
        LawLoop<Lanes>::add(state.elasticity, arguments(elongation, speed), elastic);
      }
    }
    keep(group, tension, elastic);
  }

  /// Adds what an expression pulls, and to the part that stores energy what it pulls at rest.
  static void add_expression(const LawTerm& law, LawArguments law_arguments, double* tension,
                             double* elastic) noexcept {
    if (law.asks_speed) {
      LawLoop<Lanes>::add(law, law_arguments, tension);
      alignas(64) double no_speed[Batch::kRows];
      Batch::fill(no_speed, 0.0);
      law_arguments.speed = no_speed;
      LawLoop<Lanes>::add(law, law_arguments, elastic);
      return;
    }
    alignas(64) double value[Batch::kRows];
    Batch::fill(value, -0.0);  // which changes no sum, not even 0
    LawLoop<Lanes>::add(law, law_arguments, value);
    const auto sum = [](Row p, Row v) { return p + v; };
    Batch::each(tension, sum, tension, value);
    Batch::each(elastic, sum, elastic, value);
  }

  static void limit(const StateTerm& state, double* tension) noexcept {
    const Row least = Lanes::every(state.min_tension);
    const Row most = Lanes::every(state.max_tension);
    Batch::each(
        tension, [&](Row p) { return Lanes::minimum(most, Lanes::maximum(least, p)); }, tension);
  }

  LawArguments arguments(const double* argument, const double* speed) const noexcept {
    return {argument,
            rows_.quantity[static_cast<std::size_t>(Quantity::kDistance)],
            rows_.elongation,
            speed,
            rows_.quantity[static_cast<std::size_t>(Quantity::kMassA)],
            rows_.quantity[static_cast<std::size_t>(Quantity::kMassB)]};
  }

  void keep(std::uint32_t group, const double* tension, const double* elastic) noexcept {
    if (group == Batch::kAll) {
      Batch::each(
          tension_, [](Row p) { return p; }, tension);
      Batch::each(
          rows_.elastic, [](Row p) { return p; }, elastic);
    } else {
      Batch::put(tension_, tension, group);
      Batch::put(rows_.elastic, elastic, group);
    }
  }

  /// Takes the rows that change into their new states: a rare thing, one row after the other.
  void enter() noexcept {
    alignas(64) double rest[Batch::kRows];
    for (std::uint32_t i = 0; i < Batch::kRows; ++i) {
      if ((rows_.changed >> i & 1U) == 0) continue;
      rows_.from[i] = rows_.state[i];
      rows_.rest_before[i] = rows_.rest_length[i];
      rows_.elastic_before[i] = rows_.elastic[i];
      rest[i] = rest_length_after(i);
    }
    for (std::uint32_t i = 0; i < Batch::kRows; ++i) {
      if ((rows_.changed >> i & 1U) == 0) continue;
      rows_.state[i] = target_[i];
      rows_.rest_length[i] = rest[i];
      rows_.elongation[i] =
          rows_.quantity[static_cast<std::size_t>(Quantity::kDistance)][i] - rest[i];
      rows_.entered[i] = rows_.now;
      if (rows_.impulse != nullptr) rows_.impulse[i] = 0.0;
      for (std::size_t s = 0; s < rows_.memory_slots; ++s) {
        rows_.memory[Batch::kRows * s + i] = __builtin_nan("");
      }
    }
    alignas(64) double no_increment[Batch::kRows];
    Batch::fill(no_increment, 0.0);
    for (std::uint32_t left = rows_.changed; left != 0;) {
      const StateIndex state = rows_.state[__builtin_ctz(left)];
      const std::uint32_t group = rows_in(state) & rows_.changed;
      find_tension(states_[state], group, no_increment);
      left &= ~group;
    }
  }

  /// An expression that has no finite value leaves the rest length as it is.
  double rest_length_after(std::uint32_t row) noexcept {
    const double before = rows_.rest_length[row];
    if (rows_.exit[row] == kNotForced) return before;
    const TransitionTerm& exit = states_[rows_.state[row]].exits[rows_.exit[row]];
    switch (exit.rest) {
      case RestCode::kKeep:
        return before;
      case RestCode::kHere:
        return rows_.quantity[static_cast<std::size_t>(Quantity::kDistance)][row];
      case RestCode::kExpression:
        break;
    }
    const double value =
        program_.evaluate(exit.rest_length, {rows_.quantity, rows_.memory}, 0)[row];
    const bool finite = __builtin_isfinite(value) != 0;
    return finite ? value : before;
  }

  void finish() noexcept {
    if (rows_.still != 0) {
      alignas(64) double none[Batch::kRows];
      Batch::fill(none, 0.0);
      Batch::put(tension_, none, rows_.still);
      Batch::put(rows_.elastic, none, rows_.still);
    }
    Batch::each(
        rows_.tension, [](Row p) { return p; }, tension_);
    if (rows_.impulse == nullptr) return;
    const Row dt = Lanes::every(rows_.dt);
    Batch::each(
        rows_.impulse, [&](Row sum, Row p) { return sum + p * dt; }, rows_.impulse, tension_);
  }

  const StateTerm* states_;
  StateMachineRows& rows_;
  ProgramLoop<Lanes> program_;
  alignas(64) double tension_[Batch::kRows];
  StateIndex target_[Batch::kRows];
};

}  // namespace cordis::engine
