// tests/campaigns/bursts.h -- when a busy host takes a core away, and for how long.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

namespace cordis::campaigns {

/// Bursts of exponential length, most of them short and none longer than a limit, with pauses in
/// between so that a given share of the time is taken.
class Bursts {
 public:
  struct Burst {
    double taken_s;
    double pause_s;  ///< after it
  };

  /// @param share      of the time that is taken, above 0 and below 1
  /// @param longest_s  no burst is longer; the mean is a twelfth of it
  Bursts(double share, double longest_s, std::uint32_t seed)
      : share_(share), longest_s_(longest_s), random_(seed) {}

  Burst next() {
    const double taken_s = std::min(longest_s_, length_(random_) * longest_s_ / 12.0);
    return {taken_s, taken_s * (1.0 - share_) / share_ * spread_(random_)};
  }

 private:
  double share_;
  double longest_s_;
  std::mt19937 random_;
  std::exponential_distribution<double> length_{1.0};
  std::uniform_real_distribution<double> spread_{0.5, 1.5};
};

}  // namespace cordis::campaigns
