// tests/plan/program_enclosure_test.cpp -- values, slopes and steps of expressions.
#include "sim_node/plan/stability/program_enclosure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using plan::LinkBox;

class RandomPrograms {
 public:
  explicit RandomPrograms(std::uint32_t seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_()) % count; }
  bool coin() { return below(2) == 0; }

  /// An expression of distance and speed. @param steps  it may choose between two values
  Term term(int depth, bool steps) {
    if (depth == 0 || below(6) == 0) return leaf();
    const auto next = [&] { return term(depth - 1, steps); };
    switch (below(steps ? 12U : 10U)) {
      case 0:
        return next() + next();
      case 1:
        return next() - next();
      case 2:
      case 3:
        return next() * next();
      case 4:
        return two(Operation::kMin, next(), next());
      case 5:
        return two(Operation::kMax, next(), next());
      case 6:
        return one(Operation::kSin, next());
      case 7:
        return one(Operation::kTanh, next());
      case 8:
        return size(next());
      case 9:
        return one(Operation::kSqrt, 0.3 + size(next()));
      case 10:
        return three(Operation::kSelect, next() > next(), next(), next());
      default:
        return (next() < next()) * next();
    }
  }
  LinkBox box() {
    const double distance = between(-1.0, 1.0);
    const double speed = between(-2.0, 2.0);
    return {{distance, distance + between(0.01, 1.5)},
            {speed, speed + between(0.01, 3.0)},
            between(-0.5, 0.5),
            {},
            {}};
  }
  double value(const Program& program, const LinkBox& box, double distance, double speed) {
    engine::LinkQuantities now{};
    now[static_cast<std::size_t>(Quantity::kDistance)] = distance;
    now[static_cast<std::size_t>(Quantity::kElongation)] = distance - box.rest_length;
    now[static_cast<std::size_t>(Quantity::kSpeed)] = speed;
    return engine::value_of(program, now);
  }
  double in(const plan::Interval& interval) { return between(interval.low, interval.high); }

 private:
  Term leaf() {
    switch (below(4)) {
      case 0:
        return q(Quantity::kDistance);
      case 1:
        return q(Quantity::kElongation);
      case 2:
        return q(Quantity::kSpeed);
      default:
        return Term(between(-3.0, 3.0));
    }
  }

  std::mt19937 random_;
};

bool lies_in(double value, const plan::Interval& interval) {
  const double spare = 1e-9 * (1.0 + std::abs(value));
  return value >= interval.low - spare && value <= interval.high + spare;
}

TEST(ProgramEnclosure, HoldsEveryValueAndTheSlopeBetweenAnyTwoPlaces) {
  RandomPrograms chance(test_seed());
  int finite = 0;
  const int count = rounds(3000);
  for (int n = 0; n < count; ++n) {
    const bool steps = chance.coin();
    const Program program = chance.term(4, steps).program;
    const LinkBox box = chance.box();
    const plan::ProgramEnclosure all = plan::enclosure_of(program, box);
    finite += std::isfinite(all.over_distance.high - all.over_distance.low) ? 1 : 0;
    for (int sample = 0; sample < 20; ++sample) {
      const double d = chance.in(box.distance);
      const double v = chance.in(box.speed);
      const double here = chance.value(program, box, d, v);
      ASSERT_TRUE(lies_in(here, all.value))
          << n << " " << here << " " << all.value.low << " " << all.value.high;
      if (steps) continue;  // between two places there may be a step
      const double far = chance.in(box.distance);
      const double fast = chance.in(box.speed);
      if (std::abs(far - d) < 1e-3 || std::abs(fast - v) < 1e-3) continue;
      ASSERT_TRUE(
          lies_in((chance.value(program, box, far, v) - here) / (far - d), all.over_distance))
          << n;
      ASSERT_TRUE(
          lies_in((chance.value(program, box, d, fast) - here) / (fast - v), all.over_speed))
          << n;
    }
  }
  EXPECT_GT(finite, count / 2);
}

TEST(ProgramEnclosure, OfANotIsOneNumberWhereItsArgumentIsSurelyZeroOrNot) {
  const Program program = one(Operation::kNot, q(Quantity::kDistance)).program;
  const auto value = [&](double low, double high) {
    return plan::enclosure_of(program, {{low, high}, {}, 0.0, {}, {}}).value;
  };
  const auto is = [](const plan::Interval& interval, double low, double high) {
    return interval.low == low && interval.high == high;
  };
  EXPECT_TRUE(is(value(0.5, 0.75), 0.0, 0.0));
  EXPECT_TRUE(is(value(-0.75, -0.5), 0.0, 0.0));
  EXPECT_TRUE(is(value(0.0, 0.0), 1.0, 1.0));
  EXPECT_TRUE(is(value(-0.5, 0.5), 0.0, 1.0));
  EXPECT_TRUE(is(value(0.0, 0.5), 0.0, 1.0));
}

TEST(ProgramEnclosure, OfAComparisonHoldsExactlyWhatItCanBe) {
  const plan::Interval intervals[] = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0},
                                      {1.0, 2.0},  {2.0, 3.0}, {-1.0, 3.0}};
  for (const Operation operation :
       {Operation::kLess, Operation::kLessOrEqual, Operation::kGreater, Operation::kGreaterOrEqual,
        Operation::kEqual, Operation::kNotEqual, Operation::kAnd, Operation::kOr}) {
    const Program program = two(operation, q(Quantity::kDistance), q(Quantity::kSpeed)).program;
    for (const plan::Interval& x : intervals) {
      for (const plan::Interval& y : intervals) {
        plan::Interval sampled{1.0, 0.0};
        constexpr int kParts = 16;  // it meets every end of the others
        for (int sample = 0; sample < (kParts + 1) * (kParts + 1); ++sample) {
          engine::LinkQuantities now{};
          now[static_cast<std::size_t>(Quantity::kDistance)] =
              x.low + (x.high - x.low) * (sample % (kParts + 1)) / kParts;
          now[static_cast<std::size_t>(Quantity::kSpeed)] =
              y.low + (y.high - y.low) * (sample / (kParts + 1)) / kParts;
          const double value = engine::value_of(program, now);
          sampled = {std::min(sampled.low, value), std::max(sampled.high, value)};
        }
        const plan::Interval found = plan::enclosure_of(program, {x, y, 0.0, {}, {}}).value;
        EXPECT_TRUE(found.low == sampled.low && found.high == sampled.high)
            << "operation " << static_cast<int>(operation) << " of " << x.low << " to " << x.high
            << " and " << y.low << " to " << y.high;
      }
    }
  }
}

/// A condition that changes within the box, of the distance, of the speed or of both.
Term changing_within(RandomPrograms& chance, const LinkBox& box) {
  const auto inner = [&chance](const plan::Interval& all) {
    const double width = all.high - all.low;
    return chance.between(all.low + 0.05 * width, all.high - 0.05 * width);
  };
  const double d = inner(box.distance);
  const double v = inner(box.speed);
  switch (chance.below(3)) {
    case 0:
      return q(Quantity::kDistance) > d;
    case 1:
      return q(Quantity::kSpeed) < v;
    default: {
      const double part = chance.between(-0.5, 0.5);
      return q(Quantity::kDistance) + part * q(Quantity::kSpeed) > d + part * v;
    }
  }
}

TEST(ProgramEnclosure, FindsStepsMuchSmallerThanWhatTheSlopesMakeOfTheBox) {
  RandomPrograms chance(test_seed());
  for (int n = 0; n < rounds(400); ++n) {
    const LinkBox box = chance.box();
    const double steep = std::pow(10.0, chance.between(-1.0, 4.0));
    const double step = steep * std::pow(10.0, chance.between(-5.0, 1.0));
    const Term smooth =
        steep * (q(Quantity::kDistance) + one(Operation::kSin, q(Quantity::kSpeed)));
    const Term when = changing_within(chance, box);
    const Term chosen = chance.coin() ? three(Operation::kSelect, when, smooth + step, smooth)
                                      : smooth + step * when;
    EXPECT_TRUE(plan::has_step(chosen.program, box, box)) << n << " " << steep << " " << step;
  }
}

TEST(ProgramEnclosure, FindsNoStepWhereTwoValuesMeet) {
  RandomPrograms chance(test_seed());
  for (int n = 0; n < rounds(400); ++n) {
    const LinkBox box = chance.box();
    const double steep = std::pow(10.0, chance.between(-1.0, 4.0));
    const bool of_distance = chance.coin();
    const plan::Interval& all = of_distance ? box.distance : box.speed;
    const double place = chance.in(all);
    const Term x = q(of_distance ? Quantity::kDistance : Quantity::kSpeed);
    const Term beyond = steep * (x - place);
    const Term bent = chance.between(0.1, 3.0) * beyond + beyond * beyond;
    const Term chosen =
        chance.coin() ? three(Operation::kSelect, x > place, beyond, bent) : (x > place) * beyond;
    EXPECT_FALSE(plan::has_step(chosen.program, box, box)) << n;
    const plan::SteepestSlopes most = plan::steepest_slopes(chosen.program, box);
    EXPECT_TRUE(std::isfinite(most.over_distance) && std::isfinite(most.over_speed)) << n;
  }
}

/// Pieces that meet, chosen by windows of the distance, as a person writes them.
TEST(ProgramEnclosure, FindsNoStepBetweenThePiecesOfAWindow) {
  RandomPrograms chance(test_seed());
  for (int n = 0; n < rounds(200); ++n) {
    const double first = chance.between(-0.5, 0.5);
    const double second = first + chance.between(0.001, 0.5);
    const double k[] = {chance.between(0.0, 1e3), chance.between(0.0, 1e3),
                        chance.between(0.0, 1e3)};
    const Term d = q(Quantity::kDistance);
    const Term low = k[0] * (d - first);
    const Term middle = k[1] * (d - first);
    const Term high = k[1] * (second - first) + k[2] * (d - second);
    const Term inside = both(d > first, d <= second);
    const LinkBox box{{first - chance.between(0.0, 0.5), second + chance.between(0.0, 0.5)},
                      {-1.0, 1.0},
                      0.1,
                      {},
                      {}};
    const Term chosen =
        three(Operation::kSelect, inside, middle, three(Operation::kSelect, d > second, high, low));
    EXPECT_FALSE(plan::has_step(chosen.program, box, box)) << n;
    const Term stepped = three(Operation::kSelect, inside, middle + 0.01,
                               three(Operation::kSelect, d > second, high, low));
    EXPECT_TRUE(plan::has_step(stepped.program, box, box)) << n;
  }
}

/// A step that some speeds alone have, and one beyond the reach.
TEST(ProgramEnclosure, FindsAStepOfSomeSpeedsAndOneFarAway) {
  const Term d = q(Quantity::kDistance);
  const Term v = q(Quantity::kSpeed);
  const LinkBox box{{0.0, 0.2}, {-1.0, 1.0}, 0.1, {}, {}};
  for (const double sign : {-1.0, 1.0}) {
    const Term push = 10.0 * two(Operation::kMax, sign * v - 0.1, 0.0);
    const Term law = 1000.0 * d + three(Operation::kSelect, d > 0.11, push, 0.0);
    EXPECT_TRUE(plan::has_step(law.program, box, box)) << sign;
  }
  LinkBox all = box;
  all.distance = {-1e9, 1e9};
  const Term far = three(Operation::kSelect, d > 3.0, 1000.0 * d + 300.0, 1000.0 * d);
  EXPECT_FALSE(plan::has_step(far.program, box, box));
  EXPECT_TRUE(plan::has_step(far.program, all, box));
}

Term any_variable(std::uint32_t number) {
  Term term(0.0);
  term.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, number}};
  return term;
}

/// Parts that count as nothing where they are finite, and are no finite number within the box.
TEST(ProgramEnclosure, HasNoSlopeWhereAPartIsNoFiniteNumber) {
  const Term d = q(Quantity::kDistance);
  const Term x = d - 0.005;
  const LinkBox box{{0.0, 0.02}, {-1.0, 1.0}, 0.0, {}, {}};
  const Term half_power = two(Operation::kPower, x, 0.5);
  const Term exponential = one(Operation::kExp, 1e7 * (d - 0.004));
  const Term two_to = two(Operation::kPower, 2.0, 1e7 * (d - 0.004));
  for (const Term& hole : {one(Operation::kSqrt, x), one(Operation::kLog, x), half_power,
                           exponential, two_to, one(Operation::kSqrt, one(Operation::kNegate, x)),
                           one(Operation::kTanh, one(Operation::kSqrt, x)),
                           one(Operation::kSign, one(Operation::kLog, x))}) {
    const Term law = 2e5 * d + 0.0 * hole;
    EXPECT_FALSE(std::isfinite(plan::steepest_slopes(law.program, box).over_distance));
    EXPECT_EQ(plan::flattest_slope(law.program, box, 2e5), -INFINITY);
    EXPECT_TRUE(plan::ends_in_a_step(law.program, box));
  }
  const Term chosen = three(Operation::kSelect, 0.0 * one(Operation::kSqrt, x) < 1.0, 2e5 * d, 0.0);
  EXPECT_FALSE(std::isfinite(plan::steepest_slopes(chosen.program, box).over_distance));
  const Term pole = 2e5 * d + 0.0 * two(Operation::kDivide, 1.0, d - 0.0050371);
  EXPECT_FALSE(std::isfinite(plan::steepest_slopes(pole.program, box).over_distance));
  EXPECT_FALSE(plan::ends_in_a_step(pole.program, box));
}

TEST(ProgramEnclosure, HasTheSlopeOfWhatIsFiniteThroughoutTheBox) {
  const Term d = q(Quantity::kDistance);
  const LinkBox box{{-0.02, 0.02}, {-1.0, 1.0}, 0.0, {}, {}};
  const Term root = one(Operation::kSqrt, d * d + 1e-6);
  const Term clamped = two(Operation::kPower, two(Operation::kMax, 0.0, d), 1.5);
  const Term guarded = three(Operation::kSelect, d > -0.01, one(Operation::kSqrt, d + 0.015), 0.0);
  for (const Term& harmless : {root, clamped, guarded, one(Operation::kExp, 1e3 * d)}) {
    const Term law = 2e5 * d + 0.0 * harmless;
    const double slope = plan::steepest_slopes(law.program, box).over_distance;
    EXPECT_GE(slope, 2e5);
    EXPECT_LT(slope, 2.1e5);
    EXPECT_FALSE(plan::ends_in_a_step(law.program, box));
  }
}

TEST(ProgramEnclosure, OfARootIsSteepOnOneSideWhereItsArgumentEndsAtMinus0) {
  const Program program =
      one(Operation::kSqrt, one(Operation::kNegate, q(Quantity::kDistance))).program;
  const plan::Interval slope =
      plan::enclosure_of(program, {{-1.0, 0.0}, {}, 0.0, {}, {}}).over_distance;
  EXPECT_EQ(slope.low, -INFINITY);
  EXPECT_EQ(slope.high, -0.5);
}

/// What is decided without the part that fails, and a root that begins at 0.
TEST(ProgramEnclosure, IsDecidedWithoutAPartThatIsNoFiniteNumber) {
  const Term d = q(Quantity::kDistance);
  const LinkBox box{{0.0, 0.02}, {-1.0, 1.0}, 0.0, {}, {}};
  const Term fails = one(Operation::kSqrt, d - 0.005) > 1.0;
  const auto value = [&](const Term& term) { return plan::values_of(term.program, box); };
  EXPECT_EQ(value(both(fails, d > 1.0)).high, 0.0);
  EXPECT_EQ(value(two(Operation::kOr, fails, d < 1.0)).low, 1.0);
  EXPECT_EQ(value(both(fails, d < 1.0)).low, 0.0);
  EXPECT_EQ(value(both(fails, d < 1.0)).high, 1.0);
  EXPECT_FALSE(plan::ends_in_a_step(one(Operation::kSqrt, d - 0.005).program, box));
}

/// A condition of variables alone holds, or does not, over all of the distance.
TEST(ProgramEnclosure, HasNoStepWhereVariablesAloneChoose) {
  const Term d = q(Quantity::kDistance);
  const std::vector<plan::Interval> variables{{0.0, INFINITY}, plan::kAnyNumber};
  LinkBox box{{-0.5, 0.5}, {-1.0, 1.0}, 0.0, {}, {}};
  box.variables = &variables;
  const Term late = any_variable(0) > 1.0;
  const Term sign = one(Operation::kSign, any_variable(1) - 1.0);
  for (const Term& stiffness :
       {three(Operation::kSelect, late, 200.0, 100.0), 150.0 + 50.0 * sign, 100.0 + 100.0 * late}) {
    const Term law = stiffness * d;
    EXPECT_EQ(plan::steepest_slopes(law.program, box).over_distance, 200.0);
    EXPECT_EQ(plan::flattest_slope(law.program, box, 200.0), 100.0);
    EXPECT_FALSE(plan::has_step(law.program, box, box));
  }
  const Term stepped =
      three(Operation::kSelect, d > 0.1, 200.0, 100.0) * (d + 0.0 * any_variable(0));
  EXPECT_TRUE(plan::has_step(stepped.program, box, box));
  const Term later =
      three(Operation::kSelect, both(d > 0.1, any_variable(0) > 5.0), 200.0, 100.0) * d;
  EXPECT_TRUE(plan::has_step(later.program, box, box));
}

}  // namespace
}  // namespace cordis::test
