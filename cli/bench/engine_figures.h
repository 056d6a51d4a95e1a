// cli/bench/engine_figures.h -- how fast the engine steps on this machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cordis::cli {

/// A step of the engine beside the plain loop over the same network, in the same turns.
struct LinkTimes {
  int dimension = 0;
  std::uint32_t masses = 0;
  std::uint32_t links = 0;
  double plain_s = 0.0;   ///< of a link and step, the update of its share of masses included
  double engine_s = 0.0;  ///< likewise

  double gain() const { return plain_s / engine_s; }
};

/// The largest scene of a kind that one core steps 1000 times a second in real time, with a fifth of
/// each period left for the exchange with devices and viewers.
struct LargestScene {
  std::string kind;
  std::string unit;  ///< of what is counted
  std::uint32_t count = 0;
  double step_s = 0.0;       ///< of the network that was measured, close to that size
  int steps_per_period = 1;  ///< of 1 ms
};

struct EngineFigures {
  std::string vector_width;
  /// The time of adding a double to the sum before: the control, which shows the clock of the core.
  double addition_s = 0.0;
  double addition_at_end_s = 0.0;       ///< the same after everything else
  std::vector<LinkTimes> by_dimension;  ///< nets of 10,000 masses
  std::vector<LinkTimes> by_size;       ///< nets in 3-D
  double ball_s = 0.0;                  ///< of a ball of an agglomerate of 2,500, and step
  std::vector<LargestScene> largest;
};

/// How much is measured.
struct BenchEffort {
  int rounds = 9;                     ///< turns of each figure
  std::uint32_t largest_side = 1000;  ///< of the nets of by_size: a million masses
};

/// @param progress  called with what is measured now
EngineFigures measure_engine(const BenchEffort& effort,
                             const std::function<void(const std::string&)>& progress);

}  // namespace cordis::cli
