// tests/engine/elementary_functions_test.cpp -- functions of expressions against the library.
#include "sim_node/engine/expressions/elementary_functions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::test {
namespace {

struct OfThisFile;
using Functions = engine::ElementaryFunctions<OfThisFile>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr int kDraws = 200'000;
constexpr double kMaxError = 2.0;  // units in the last place

static_assert(std::numeric_limits<long double>::digits >= 64, "the reference has more bits");

/// Distance of a value from the true one, in units in the last place of the true one.
double error_of(double value, long double expected) {
  const auto nearest = static_cast<double>(expected);
  if (std::isnan(nearest) || std::isinf(nearest)) {
    const bool same = std::isnan(nearest) ? std::isnan(value) : value == nearest;
    return same ? 0.0 : kInfinite;
  }
  if (std::isnan(value)) return kInfinite;
  int exponent = 0;
  std::frexp(nearest, &exponent);
  const double unit = std::ldexp(1.0, std::max(exponent - 53, -1074));
  return static_cast<double>(std::abs(static_cast<long double>(value) - expected)) / unit;
}

struct Function {
  const char* name;
  double (*own)(double);
  long double (*reference)(long double);
  std::vector<double> ranges;  // largest arguments, of either sign
};

const std::vector<Function>& functions() {
  static const std::vector<double> angles{1e-9, 0.8, 4.0, 100.0, 1e5, 2e6, 1e17, 8.9e307};
  static const std::vector<Function> all{
      {"exp", Functions::exp, std::exp, {1e-9, 0.4, 1.0, 30.0, 745.0}},
      {"log", Functions::log, std::log, {1e-310, 1e-300, 1.0, 2.0, 1e5, 1e300}},
      {"sin", Functions::sin, std::sin, angles},
      {"cos", Functions::cos, std::cos, angles},
      {"tanh", Functions::tanh, std::tanh, {1e-9, 0.3, 0.6, 2.0, 25.0, 1e5}},
  };
  return all;
}

/// Both are NaN, or they are equal with equal signs of zero.
void expect_same(double value, double expected, const std::string& what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(value)) << what;
  } else {
    EXPECT_EQ(value, expected) << what;
    EXPECT_EQ(std::signbit(value), std::signbit(expected)) << what;
  }
}

TEST(ElementaryFunctions, AreWithinTwoUnitsInTheLastPlace) {
  std::mt19937_64 random(1990);
  for (const Function& function : functions()) {
    for (const double range : function.ranges) {
      std::uniform_real_distribution<double> draw(-range, range);
      double worst = 0.0;
      double worst_argument = 0.0;
      for (int i = 0; i < kDraws; ++i) {
        const double x = draw(random);
        const double error = error_of(function.own(x), function.reference(x));
        if (error > worst) worst_argument = x;
        worst = std::max(worst, error);
      }
      EXPECT_LT(worst, kMaxError) << function.name << " at " << worst_argument;
    }
  }
}

TEST(ElementaryFunctions, KeepTheirErrorNextToQuarterTurns) {
  double worst = 0.0;
  for (int k = 1; k < 63'662; ++k) {
    const auto nearest = static_cast<double>(k * std::numbers::pi_v<long double> / 2.0L);
    for (const double x : {std::nextafter(nearest, 0.0), nearest, std::nextafter(nearest, 1e9)}) {
      worst = std::max({worst, error_of(Functions::sin(x), std::sin(static_cast<long double>(x))),
                        error_of(Functions::cos(x), std::cos(static_cast<long double>(x)))});
    }
  }
  EXPECT_LT(worst, kMaxError);
}

TEST(ElementaryFunctions, KeepTheirErrorAtAnglesOfAllSizesNextToQuarterTurns) {
  // 6381956970095103 * 2^797 is nearer to a quarter turn than any other double, by 2^-61.
  std::vector<double> angles{0x1p20, std::nextafter(0x1p20, 2e6),
                             std::ldexp(6381956970095103.0, 797)};
  std::mt19937_64 random(1992);
  std::uniform_real_distribution<double> quarters(std::log(0x1p20), std::log(0x1p52));
  for (int i = 0; i < 20'000; ++i) {
    const long double count = std::round(std::exp(quarters(random)));
    const auto nearest = static_cast<double>(count * std::numbers::pi_v<long double> / 2.0L);
    for (const double x : {std::nextafter(nearest, 0.0), nearest, std::nextafter(nearest, 1e300)})
      angles.push_back(x);
  }
  for (int exponent = 20; exponent < 1024; ++exponent) angles.push_back(std::ldexp(1.0, exponent));
  double worst = 0.0;
  for (const double angle : angles) {
    for (const double x : {angle, -angle}) {
      worst = std::max({worst, error_of(Functions::sin(x), std::sin(static_cast<long double>(x))),
                        error_of(Functions::cos(x), std::cos(static_cast<long double>(x)))});
    }
  }
  EXPECT_LT(worst, kMaxError);
}

TEST(ElementaryFunctions, AreContinuousWhereTheWayOfReducingAnAngleChanges) {
  for (double x = 0x1p20 - 3 * 0x1p-33, end = 0x1p20 + 1e-9; x < end; x = std::nextafter(x, end)) {
    EXPECT_NEAR(Functions::sin(x) - Functions::sin(0x1p20), std::cos(0x1p20) * (x - 0x1p20), 3e-16);
  }
}

TEST(ElementaryFunctions, KeepTheirErrorNextToOne) {
  double worst = 0.0;
  double x = 1.0 - 1000 * 0x1p-53;
  for (int i = 0; i < 2000; ++i, x = std::nextafter(x, 2.0)) {
    worst = std::max(worst, error_of(Functions::log(x), std::log(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, kMaxError);
}

TEST(ElementaryFunctions, PowersAreWithinTwoUnitsInTheLastPlace) {
  struct Range {
    double lowest;
    double highest;
    double exponent;
  };
  std::mt19937_64 random(1991);
  for (const Range& range : {Range{0.0, 10.0, 20.0}, Range{0.99, 1.01, 7e4}, Range{0.0, 1e5, 60.0},
                             Range{0.0, 1e-310, 1.0}, Range{0.5, 2.0, 1000.0}}) {
    std::uniform_real_distribution<double> base(range.lowest, range.highest);
    std::uniform_real_distribution<double> exponent(-range.exponent, range.exponent);
    double worst = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const double x = base(random);
      const double y = exponent(random);
      const long double expected = std::pow(static_cast<long double>(x), y);
      worst = std::max(worst, error_of(Functions::power(x, y), expected));
    }
    EXPECT_LT(worst, kMaxError) << range.lowest << " to " << range.highest;
  }
}

TEST(ElementaryFunctions, WholePowersMultiply) {
  for (const double x : {1.1, -0.7, 3.0}) {
    double product = 1.0;
    for (int n = 0; n <= engine::kMaxWholePower; ++n, product *= x) {
      EXPECT_NEAR(Functions::power(x, n) / product, 1.0, 1e-14);
      EXPECT_NEAR(Functions::power(x, -n) * product, 1.0, 1e-14);
    }
  }
  EXPECT_EQ(Functions::power(3.0, 4.0), 81.0);
  EXPECT_EQ(Functions::power(-2.0, -3.0), -0.125);
}

TEST(ElementaryFunctions, TreatSpecialArgumentsAsIeeeAsks) {
  const std::vector<double> special{
      0.0,   -0.0,  1.0,    -1.0,   0.5,       -0.5,       2.0,          -3.0,   65.0,
      -66.0, -67.0, 1e300,  -1e300, 1e-320,    -1e-320,    0x1p53 - 1.0, 0x1p53, 1e19,
      709.9, 800.0, -745.1, -746.1, kInfinite, -kInfinite, kNotANumber};
  for (const double x : special) {
    for (const Function& function : functions()) {
      const std::string what = function.name + (" of " + std::to_string(x));
      const long double expected = function.reference(x);
      const auto nearest = static_cast<double>(expected);
      EXPECT_LT(error_of(function.own(x), expected), kMaxError) << what;
      if (nearest == 0.0 || std::isinf(nearest)) expect_same(function.own(x), nearest, what);
    }
    for (const double y : special) {
      const std::string what = std::to_string(x) + " ^ " + std::to_string(y);
      const double expected = std::pow(x, y);
      if (expected == 0.0 || !std::isfinite(expected)) {
        expect_same(Functions::power(x, y), expected, what);
      } else {
        EXPECT_LT(error_of(Functions::power(x, y), std::pow(static_cast<long double>(x), y)),
                  kMaxError)
            << what;
      }
    }
  }
}

}  // namespace
}  // namespace cordis::test
