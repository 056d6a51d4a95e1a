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
  double plain_s = 0.0;   ///< time per link and step, with the update of its share of masses
  double engine_s = 0.0;  ///< likewise

  double gain() const { return plain_s / engine_s; }
};

/// The largest scene of a kind that one core steps 1000 times a second in real time, with a fifth of
/// each period left for the exchange with devices and viewers.
struct LargestScene {
  std::string kind;
  std::string unit;  ///< what `count` counts
  std::uint32_t count = 0;
  double step_s = 0.0;       ///< step time of the measured network, which has nearly that size
  int steps_per_period = 1;  ///< steps in a period of 1 ms
};

struct EngineFigures {
  std::string vector_width;
  /// The time of adding a double to the sum before: the control, which shows the clock of the core.
  double addition_s = 0.0;
  double addition_at_end_s = 0.0;       ///< the addition again, after everything else
  std::vector<LinkTimes> by_dimension;  ///< nets of 10,000 masses
  std::vector<LinkTimes> by_size;       ///< nets in 3-D
  double ball_s = 0.0;                  ///< time per ball and step, in an agglomerate of 2,500
  std::vector<LargestScene> largest;
};

/// How much is measured.
struct BenchEffort {
  int rounds = 9;                     ///< turns of each figure
  std::uint32_t largest_side = 1000;  ///< side of the largest net in by_size: a million masses
};

/// @param progress  called with what is measured now
EngineFigures measure_engine(const BenchEffort& effort,
                             const std::function<void(const std::string&)>& progress);

}  // namespace cordis::cli
