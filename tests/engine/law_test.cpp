// tests/engine/law_test.cpp -- what holds for the laws of every kind, with random parameters.
#include "sim_node/engine/laws/law.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
#include "tests/engine/programs.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using engine::kStateBatch;
using engine::Law;
using engine::LawArgument;
using engine::LawPoint;
using engine::LawRange;
using engine::LawSlope;
using engine::VectorWidth;

constexpr int kRounds = 300;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

Law random_table(std::mt19937& random) {
  std::vector<double> arguments{between(random, -0.4, 0.0)};
  std::vector<double> value{between(random, -5.0, 5.0)};
  for (auto left = random() % 6; left > 0; --left) {
    arguments.push_back(arguments.back() + between(random, 0.01, 0.3));
    value.push_back(between(random, -5.0, 5.0));
  }
  return engine::Table(arguments, value);
}

Law random_power(std::mt19937& random) {
  return engine::Power{between(random, -2.0, 5.0), 0.5 * static_cast<double>(random() % 9)};
}

Law random_lennard_jones(std::mt19937& random) {
  const double diameter = between(random, 0.1, 1.0);
  const double cutoff = random() % 2 == 0 ? 0.0 : between(random, 1.2, 3.0) * diameter;
  return engine::LennardJones{between(random, 0.0, 2.0), diameter, cutoff};
}

Law random_rings(std::mt19937& random) {
  engine::Rings law;
  for (auto left = 1 + random() % 4; left > 0; --left) {
    law.rings.push_back({between(random, -20.0, 40.0), between(random, 0.1, 1.5)});
  }
  return law;
}

Law random_expression(std::mt19937& random) {
  const Term d = q(Quantity::kDistance);
  const Term e = q(Quantity::kElongation);
  const Term v = q(Quantity::kSpeed);
  const Term masses = q(Quantity::kMassA) - q(Quantity::kMassB);
  return expression_law(between(random, -5.0, 5.0) * e * e * e +
                        one(Operation::kTanh, between(random, -3.0, 3.0) * v) / d +
                        between(random, -1.0, 1.0) * masses * v +
                        one(Operation::kSqrt, e + between(random, 0.0, 1.0)));
}

Law random_law(std::mt19937& random) {
  constexpr std::array kMake{random_table, random_power, random_lennard_jones, random_rings,
                             random_expression};
  static_assert(std::variant_size_v<Law> == kMake.size() + 1, "a law is not tested");
  return kMake[random() % kMake.size()](random);
}

/// Runs a check of many random laws.
template <class Check>
void with_random_laws(Check check) {
  const std::uint32_t seed = test_seed();
  std::mt19937 random(seed);
  for (int n = 0; n < kRounds && !testing::Test::HasFatalFailure(); ++n) {
    const Law law = random_law(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(n) + ", law " +
                 std::to_string(law.index()));
    check(law, random);
  }
}

TEST(Law, IsTheSlopeOfItsPotential) {
  with_random_laws([](const Law& law, std::mt19937& random) {
    constexpr double kStep = 1e-5;
    const double rest_length = between(random, 0.5, 1.0);
    const auto energy = [&](double e) { return potential(law, {rest_length + e, e}); };
    const auto tension = [&](double e) { return elastic_tension(law, {rest_length + e, e}); };
    for (int i = 0; i < 20; ++i) {
      const double e = between(random, -0.45, 1.0);
      const double slope = (energy(e + kStep) - energy(e - kStep)) / (2.0 * kStep);
      if (!stores_energy(law) && tension(e) == 0.0) continue;  // beyond where it has a value
      // The mean of the tension between the two, which rounding of the energy blurs, or its quadrature.
      const double blur = stores_energy(law) ? 1e-9 : 1e-3;
      const double change =
          std::abs(tension(e + kStep) - tension(e)) + std::abs(tension(e) - tension(e - kStep));
      ASSERT_NEAR(slope, tension(e), change + blur * (1.0 + std::abs(energy(e)))) << "at " << e;
    }
  });
}

/// A mass that passes over many hills has no more energy far away than near.
TEST(Law, OfManyWavesStoresTheIntegralOfItsTension) {
  const Law waves = engine::Expression{
      (Term(3.0) * one(Operation::kSin, Term(200.0) * q(Quantity::kElongation))).program};
  for (const double e : {0.01, 0.2, 1.0, 7.1, -7.1}) {
    const double exact = 3.0 / 200.0 * (1.0 - std::cos(200.0 * e));
    EXPECT_NEAR(potential(waves, {e + 0.3, e}), exact, 1e-8) << e;
  }
}

TEST(Law, IsNowhereSteeperThanItsLargestSlope) {
  with_random_laws([](const Law& law, std::mt19937& random) {
    LawRange range{between(random, 0.1, 0.5), between(random, 0.5, 1.0), between(random, 0.0, 9.0)};
    range.viscous = argument_of(law) != LawArgument::kDistance && random() % 2 == 0;
    range.turns = !range.viscous && random() % 2 == 0;
    const auto tension = [&](double argument) {
      return range.viscous ? viscous_tension(law, {range.rest_length, 0.0, argument})
                           : elastic_tension(law, {range.rest_length + argument, argument});
    };
    double low = -range.argument;
    double high = range.argument;
    const LawSlope largest = largest_slope(law, range);
    if (largest.infinite_at_zero) low = 0.01 * range.argument;
    if (argument_of(law) == LawArgument::kDistance) {
      low = 0.0 - range.rest_length;
      high = 2.0 - range.rest_length;
    }
    if (const auto* balls = std::get_if<engine::LennardJones>(&law)) {
      const double energy = std::max(1.0, range.energy / balls->well_depth);
      const double turn = balls->diameter * std::pow(0.5 + 0.5 * std::sqrt(1.0 + energy), -1.0 / 6);
      low = turn - range.rest_length;
    }
    // A tension that lasts as the ends meet, or jumps, has no largest slope across the link.
    const bool across = range.turns && largest.bounded && !largest.infinite_at_zero &&
                        tension(-range.rest_length) <= 0.0;
    const double width = (high - low) / 400.0;
    ASSERT_TRUE(std::isfinite(largest.value));
    for (int i = 0; i < 400; ++i) {
      const double argument = low + width * i;
      const double slope = (tension(argument + width) - tension(argument)) / width;
      ASSERT_LE(slope, largest.value + 1e-9 * (1.0 + std::abs(tension(argument)) + largest.value))
          << "at " << argument;
      if (!across || i == 0) continue;
      ASSERT_LE(tension(argument) / (range.rest_length + argument), largest.value * (1.0 + 1e-9))
          << "at " << argument;
    }
  });
}

TEST(Law, HasTheSameBitsForOneLinkAndForEight) {
  const auto bits = [](double value) {
    return std::bit_cast<std::uint64_t>(std::isnan(value) ? std::nan("") : value + 0.0);
  };
  with_random_laws([&](const Law& law, std::mt19937& random) {
    LinkState state;
    state.elasticity = law;
    do {
      state.dissipation = random_law(random);
    } while (argument_of(state.dissipation) == LawArgument::kDistance);
    const engine::StateTable table({Behaving().state(state).state_machine}, 1.0);
    const auto any = [&random] {
      constexpr std::array kSpecial{0.0, -0.0, 0.5, 1e200, -1e200, 1e-200, 1.0};
      return random() % 3 == 0 ? kSpecial[random() % kSpecial.size()] : between(random, -2.0, 2.0);
    };
    alignas(64) std::array<std::array<double, kStateBatch>, 8> row{};
    auto& [distance, one, speed, rest_length, mass_a, mass_b, found, viscous] = row;
    for (auto& values : row) std::generate(values.begin(), values.end(), any);
    one.fill(1.0);
    for (const VectorWidth width : engine::supported_vector_widths()) {
      engine::state_kernel(width).tensions(
          table.terms()[0],
          {kStateBatch, distance.data(), one.data(), speed.data(), rest_length.data(),
           mass_a.data(), mass_b.data(), 1.0, found.data(), viscous.data()});
      for (std::size_t i = 0; i < kStateBatch; ++i) {
        const LawPoint link{distance[i], distance[i] - rest_length[i], speed[i], mass_a[i],
                            mass_b[i]};
        const double expected =
            elastic_tension(law, link) + viscous_tension(state.dissipation, link);
        ASSERT_EQ(bits(found[i]), bits(expected)) << engine::to_string(width) << ", row " << i;
      }
    }
  });
}

TEST(Law, OfADissipationIsNoFunctionOfTheDistance) {
  EXPECT_THROW(engine::check_dissipation(engine::Rings{{{1.0, 1.0}}}, "law"),
               std::invalid_argument);
  EXPECT_THROW(engine::check_dissipation(engine::LennardJones{1.0, 1.0}, "law"),
               std::invalid_argument);
  with_random_laws([](const Law& law, std::mt19937& /*random*/) {
    ASSERT_NO_THROW(engine::check_elasticity(law, "law"));
  });
}

}  // namespace
}  // namespace cordis::test
