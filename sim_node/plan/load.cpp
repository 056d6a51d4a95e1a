// sim_node/plan/load.cpp
#include "sim_node/plan/load.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

#include "sim_node/engine/world.h"

namespace cordis::plan {

double measure_step_nsec(const engine::NetworkDescription& network) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kAtLeast{50};
  constexpr int kBatches = 10;
  constexpr int kFewest = 3;  // steps in a batch
  engine::World world(std::make_shared<const engine::Network>(network));
  const Clock::time_point begin = Clock::now();
  double quickest = std::numeric_limits<double>::infinity();
  for (int batch = 0, steps = kFewest; batch < kBatches || Clock::now() - begin < kAtLeast;
       ++batch) {
    const Clock::time_point from = Clock::now();
    for (int n = 0; n < steps; ++n) world.step();
    const std::chrono::duration<double, std::nano> taken = Clock::now() - from;
    quickest = std::min(quickest, taken.count() / steps);
    if (taken < kAtLeast / (2 * kBatches)) steps *= 2;  // the clock itself costs time
  }
  return quickest;
}

}  // namespace cordis::plan
