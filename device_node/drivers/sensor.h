// device_node/drivers/sensor.h -- what a simulated sensor makes of what it measures.
#pragma once

#include <cmath>
#include <cstdint>

namespace cordis::device {

/// Errors of one kind of sensor, in the unit of the reading: [m] or [N].
struct SensorSettings {
  double noise = 0.0;    ///< standard deviation, >= 0
  double quantum = 0.0;  ///< distance of two readings, >= 0; 0: none
};

/// Adds noise to a reading, then rounds it to its grid. The noise comes from a seed alone: the
/// same seed, the same readings, on every machine (sum of twelve uniform numbers, no functions of
/// the mathematical library; SplitMix64).
class Sensor {
 public:
  Sensor() = default;
  Sensor(const SensorSettings& settings, std::uint64_t seed) noexcept
      : settings_(settings), seed_(seed), state_(seed) {}

  void start() noexcept { state_ = seed_; }

  double read(double value) noexcept {
    if (settings_.noise > 0.0) value += settings_.noise * normal();
    if (settings_.quantum > 0.0) value = settings_.quantum * std::round(value / settings_.quantum);
    return value;
  }

 private:
  double normal() noexcept {
    double sum = -6.0;
    for (int n = 0; n < 12; ++n) sum += static_cast<double>(next() >> 11) * 0x1.0p-53;
    return sum;
  }
  std::uint64_t next() noexcept {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  SensorSettings settings_;
  std::uint64_t seed_ = 0;
  std::uint64_t state_ = 0;
};

}  // namespace cordis::device
