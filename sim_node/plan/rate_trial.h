// sim_node/plan/rate_trial.h -- the lowest rate that keeps a tolerance, found by trying.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

struct RateTrialOptions {
  double tolerance = 0.01;  ///< root of the mean square of position errors, over that of the motion
  double over_s = 1.0;      ///< for so long from the start
  double lowest_hz = 0.0;   ///< not below; a multiple of the next
  double unit_hz = 1000.0;  ///< the rate is a multiple of it
  double highest_hz = 1e6;  ///< not above
};

/// A body is what linear links, links with states and Maxwell elements join. Its own motion is that of its
/// masses against their mean, and the whole of it where it is joined to what does not move freely.
struct OwnError {
  /// Root of the mean square of its own position errors, over that of its own motion.
  double error = 0.0;
  std::uint32_t mat = 0;  ///< the first mass of the body
};

struct RateTrial {
  double rate_hz = 0.0;  ///< 0: none was found
  double error = 0.0;    ///< at this rate, as estimated
  /// The body whose own motion is off by the most. It may be off by far more than the whole, beside what
  /// travels far. None where no body moves by itself.
  std::optional<OwnError> worst_body;
  std::string refusal;  ///< why none was found
};

/// Plays the network by itself, its ports at rest, at rates that double. The error is the
/// difference from the rate four times as high, over all steps. Between two rates it goes by the
/// order they show. Gives up where the errors do not fall and two rates keep together no longer
/// (the motion is chaotic), and after a fixed amount of work: a second at most, on a machine as
/// they are. The same choice on every machine.
RateTrial find_rate(const engine::NetworkDescription& network, const std::string& integrator,
                    const RateTrialOptions& options);

}  // namespace cordis::plan
