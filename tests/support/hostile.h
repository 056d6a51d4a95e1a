// tests/support/hostile.h -- numbers that must never be sent.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <random>

namespace cordis::test {

/// Draws numbers from the edges of their types and from between; the same for the same seed.
class Hostile {
 public:
  explicit Hostile(std::uint64_t seed) : random_(seed) {}

  bool chance(double share) { return std::uniform_real_distribution(0.0, 1.0)(random_) < share; }

  double real() {
    constexpr double kMax = std::numeric_limits<double>::max();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
    constexpr std::array kEdges{0.0,  -0.0,  1e300,      -1e300,    kMax, -kMax, kInfinity,
                                kNan, -kNan, -kInfinity, kSmallest, 1e3,  -1e6,  1e-300};
    if (chance(0.5)) return kEdges.at(random_() % kEdges.size());
    return std::uniform_real_distribution(-0.1, 0.1)(random_);
  }

  std::uint64_t whole() {
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
    constexpr std::array kEdges{
        std::uint64_t{0},       std::uint64_t{1}, kMax, kMax - 1, kMax / 2, kMax / 2 + 1,
        std::uint64_t{1} << 32, std::uint64_t{17}};
    if (chance(0.6)) return kEdges.at(random_() % kEdges.size());
    return chance(0.5) ? random_() : random_() % 3000;
  }

  std::uint32_t word() { return static_cast<std::uint32_t>(whole()); }
  std::int64_t time() { return static_cast<std::int64_t>(whole()); }

  /// One in four times hostile, else the true number.
  template <class Number, class Draw>
  Number or_true(Number truth, Draw draw) {
    return chance(0.25) ? draw() : truth;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace cordis::test
