// sim_node/plan/rate.h -- the lowest rate that keeps what a scene asks for.
#pragma once

#include <cstdint>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// What a scene asks for instead of a rate.
struct AccuracyTarget {
  double tolerance = 0.01;      ///< largest relative error of pitch, rate of decay and creep
  double band_hz = 100.0;       ///< highest frequency of vibrations that keep the tolerance
  double contact_energy = 0.1;  ///< largest part of its energy that a collision may gain or lose
  double over_s = 0.0;          ///< [s]
  double highest_hz = 1e6;      ///< the highest rate that may be chosen
};

/// What made the rate as high as it is.
enum class RateReason : std::uint8_t {
  kGesture = 0,  ///< one step per gesture is enough
  kStability,    ///< 0.9 of the certified step
  kContact,      ///< K' <= 4 e / (1 + e) for the stiffest liaison that comes and goes
  kPitch,        ///< at the end of the band
  kDecay,
  kCreep,  ///< the slower mode there, where viscosity lets nothing swing
  kPulse   ///< a step is no longer than the narrowest pulse of a table
};

struct FormulaRate {
  double needed_hz = 0.0;  ///< the least that serves
  double rate_hz = 0.0;    ///< the next multiple of the gesture rate
  RateReason reason = RateReason::kGesture;
};

/// The least multiple of a unit that is not below a rate, but for its rounding [1/s].
double multiple_from(double rate_hz, double unit_hz) noexcept;

/// For the integrator of the network; its step does not matter. O(liaisons).
FormulaRate rate_by_formula(const engine::NetworkDescription& network, const AccuracyTarget& target,
                            double gesture_rate_hz);

/// For a person: "the pitch at the end of the band".
const char* to_string(RateReason reason) noexcept;

}  // namespace cordis::plan
