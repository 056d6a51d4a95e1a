// sim_node/plan/reference/load.cpp
#include "sim_node/plan/reference/load.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reference/thread_time.h"

namespace cordis::plan {
namespace {

constexpr double kWithoutSets = 5e7;  // [ns]
constexpr double kWithSets = 5e8;     // [ns]
constexpr double kOfOneBatch = 2e4;   // [ns]: the clock itself takes some hundred
constexpr std::size_t kWarmUp = 3;    // batches: the caches fill
constexpr std::size_t kMaxBatches = 50'000;

}  // namespace

StepLoad measure_steps(engine::NetworkDescription network) {
  network.freeze_tolerance = 0.0;
  const double enough = network.sets.empty() ? kWithoutSets : kWithSets;
  engine::World world(std::make_shared<const engine::Network>(std::move(network)));
  StepLoad load;
  std::vector<double> batches;  // [ns] of a step
  std::size_t steps = 1;        // of a batch
  double total = 0.0;
  do {
    const double from = thread_nsec();
    for (std::size_t n = 0; n < steps; ++n) {
      if (world.step().wants_room) world.make_room();
    }
    const double taken = thread_nsec() - from;
    total += taken;
    load.step_count += steps;
    if (taken < kOfOneBatch && batches.size() <= kWarmUp) {
      steps *= 2;
      batches.clear();
    }
    batches.push_back(taken / static_cast<double>(steps));
  } while (total < enough && batches.size() < kMaxBatches);
  if (batches.size() > 2 * kWarmUp) batches.erase(batches.begin(), batches.begin() + kWarmUp);
  std::sort(batches.begin(), batches.end());
  load.median_nsec = batches[batches.size() / 2];
  load.worst_nsec = batches.back();
  return load;
}

}  // namespace cordis::plan
