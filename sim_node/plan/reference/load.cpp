// sim_node/plan/reference/load.cpp
#include "sim_node/plan/reference/load.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include "sim_node/engine/world.h"

namespace cordis::plan {

double measure_step_nsec(engine::NetworkDescription network) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kAtLeast{50};
  constexpr std::chrono::milliseconds kAtMost{250};
  constexpr int kBatches = 10;
  network.freeze_tolerance = 0.0;
  engine::World world(std::make_shared<const engine::Network>(std::move(network)));
  const Clock::time_point begin = Clock::now();
  double quickest = std::numeric_limits<double>::infinity();
  for (int batch = 0, steps = 1;; ++batch) {
    const Clock::time_point from = Clock::now();
    if (batch > 0 && from - begin > (batch < kBatches ? kAtMost : kAtLeast)) break;
    for (int n = 0; n < steps; ++n) world.step();
    const std::chrono::duration<double, std::nano> taken = Clock::now() - from;
    quickest = std::min(quickest, taken.count() / steps);
    if (taken < kAtLeast / (2 * kBatches)) steps *= 2;  // the clock itself costs time
  }
  return quickest;
}

}  // namespace cordis::plan
