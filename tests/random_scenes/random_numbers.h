// tests/random_scenes/random_numbers.h -- the numbers of one idea of a scene.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace cordis::test {

/// A source of random numbers of its own: what another source draws does not depend on it.
/// A seed gives the same numbers on every machine.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint32_t seed) : random_(seed) {}

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  double decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  template <class T>
  T one_of(std::initializer_list<T> all) {
    return *(all.begin() + below(static_cast<std::uint32_t>(all.size())));
  }

 private:
  std::mt19937 random_;
};

}  // namespace cordis::test
