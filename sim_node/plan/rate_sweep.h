// sim_node/plan/rate_sweep.h -- the rates at which a network is tried out.
#pragma once

#include <vector>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/reference/reference.h"

namespace cordis::plan {

struct RateSweepOptions {
  double duration = 2.0;         ///< length of a run, at least [s]
  double own_hz = 0.0;           ///< the rate of the scene itself
  double highest_factor = 64.0;  ///< the highest rate over the lowest stable one
  bool coarse = false;           ///< twice as much from rung to rung, instead of 1.33 or 1.5 times
  double resolving_hz = 0.0;     ///< steps of this rate resolve every vibration; 0: of the limit
  int max_samples = 200;         ///< samples of one rate
};

/// Rates from below the limit upwards, round numbers all, multiples of one rate. Each has samples at
/// steps of its own, spread unevenly: what vibrates in time with them would seem to rest.
struct RateSweep {
  std::vector<double> rates_hz;  ///< ascending
  Sampling sampling;
};

/// @param limit_hz  below it a run diverges; 0 when it never does
RateSweep make_rate_sweep(double limit_hz, const RateSweepOptions& options);

}  // namespace cordis::plan
