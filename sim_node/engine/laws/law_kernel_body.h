// sim_node/engine/laws/law_kernel_body.h -- the value of a law for 8 rows at a time.
//
// Powers are made by multiplication and square root alone: those round the same everywhere.
#pragma once

#include "sim_node/engine/expressions/program_kernel_body.h"
#include "sim_node/engine/laws/law_term.h"
#include "sim_node/engine/simd/lane_batch.h"

namespace cordis::engine {

/// What a law may depend on; 8 values each.
struct LawArguments {
  const double* argument;    // elongation or speed: of a table or a power
  const double* distance;    // of Lennard-Jones and rings
  const double* elongation;  // of an expression, with those below and the distance
  const double* speed;
  const double* mass_a;
  const double* mass_b;
};

template <class Lanes>
struct LawLoop {
  using Row = typename Lanes::Row;
  using Batch = LaneBatch<Lanes>;

  /// Adds the pull of the law to `pull`.
  static void add(const LawTerm& law, const LawArguments& of, double* pull) noexcept {
    switch (law.code) {
      case LawCode::kNone:
        return;
      case LawCode::kTable:
        return add_table(law, of.argument, pull);
      case LawCode::kPower:
        return add_power(law, of.argument, pull);
      case LawCode::kLennardJones:
        return add_lennard_jones(law, of.distance, pull);
      case LawCode::kRings:
        return add_rings(law, of.distance, pull);
      case LawCode::kExpression:
        return add_expression(law, of, pull);
    }
  }

 private:
  static void add_table(const LawTerm& law, const double* argument, double* pull) noexcept {
    alignas(64) double clamped[Batch::kRows];
    alignas(64) double at[Batch::kRows];
    alignas(64) double value[Batch::kRows];
    alignas(64) double slope[Batch::kRows];
    const Row first = Lanes::every(law.at[0]);
    const Row last = Lanes::every(law.at[law.count - 1]);
    Batch::each(
        clamped, [&](Row u) { return Lanes::minimum(last, Lanes::maximum(first, u)); }, argument);
    for (std::size_t i = 0; i < Batch::kRows; ++i) {
      const std::size_t point = last_point_up_to(law, clamped[i]);
      at[i] = law.at[point];
      value[i] = law.value[point];
      slope[i] = law.slope[point];
    }
    Batch::each(
        pull, [](Row p, Row u, Row a, Row v, Row s) { return p + (v + s * (u - a)); }, pull,
        clamped, at, value, slope);
  }

  /// Bisection without a branch on a value.
  static std::size_t last_point_up_to(const LawTerm& law, double argument) noexcept {
    std::size_t first = 0;
    std::size_t count = law.count;
    while (count > 1) {
      const std::size_t half = count / 2;
      first += law.at[first + half] <= argument ? half : 0;
      count -= half;
    }
    return first;
  }

  static void add_power(const LawTerm& law, const double* argument, double* pull) noexcept {
    const Row coefficient = Lanes::every(law.coefficient);
    const auto of = [&](Row p, Row u) {
      Row base = Lanes::magnitude(u);
      Row power = (law.half_powers & 1U) != 0 ? Lanes::sqrt(base) : Lanes::every(1.0);
      for (std::uint32_t n = law.half_powers >> 1; n != 0; n >>= 1) {
        if ((n & 1U) != 0) power = power * base;
        base = base * base;
      }
      power = coefficient * power;
      power = Lanes::select(Lanes::less(u, Lanes::zero()), -power, power);
      return p + Lanes::select(Lanes::equal(u, Lanes::zero()), Lanes::zero(), power);
    };
    Batch::each(pull, of, pull, argument);
  }

  static void add_lennard_jones(const LawTerm& law, const double* distance, double* pull) noexcept {
    const Row attraction = Lanes::every(law.attraction);
    const Row repulsion = Lanes::every(law.repulsion);
    const Row cut = Lanes::every(law.cut);
    const auto of = [&](Row p, Row d) {
      const Row inverse = Lanes::every(1.0) / d;
      const Row square = inverse * inverse;
      const Row sixth = square * square * square;
      const Row slope = (attraction - repulsion * sixth) * sixth * inverse;
      const auto within =
          Lanes::both(Lanes::less(Lanes::magnitude(d), cut), Lanes::not_equal(d, Lanes::zero()));
      return p + Lanes::select(within, slope, Lanes::zero());
    };
    Batch::each(pull, of, pull, distance);
  }

  static void add_rings(const LawTerm& law, const double* distance, double* pull) noexcept {
    for (std::size_t r = 0; r < law.count; ++r) {
      const Row stiffness = Lanes::every(law.rings[r].stiffness);
      const Row radius = Lanes::every(law.rings[r].radius);
      const auto of = [&](Row p, Row d) {
        return p - Lanes::select(Lanes::less(d, radius), stiffness * (radius - d), Lanes::zero());
      };
      Batch::each(pull, of, pull, distance);
    }
  }

  /// A value that is not finite counts as 0.
  static void add_expression(const LawTerm& law, const LawArguments& of, double* pull) noexcept {
    const double* quantity[kQuantityCount] = {};
    quantity[static_cast<std::size_t>(Quantity::kDistance)] = of.distance;
    quantity[static_cast<std::size_t>(Quantity::kElongation)] = of.elongation;
    quantity[static_cast<std::size_t>(Quantity::kSpeed)] = of.speed;
    quantity[static_cast<std::size_t>(Quantity::kMassA)] = of.mass_a;
    quantity[static_cast<std::size_t>(Quantity::kMassB)] = of.mass_b;
    ProgramLoop<Lanes> program;
    const double* value = program.evaluate(law.expression, {quantity, nullptr}, 0);
    const Row endless = Lanes::every(__builtin_huge_val());
    const auto finite = [&](Row p, Row v) {
      const auto is_finite = Lanes::less(Lanes::magnitude(v), endless);
      return p + Lanes::select(is_finite, v, Lanes::zero());
    };
    Batch::each(pull, finite, pull, value);
  }
};

}  // namespace cordis::engine
