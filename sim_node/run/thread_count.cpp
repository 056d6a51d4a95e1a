// sim_node/run/thread_count.cpp
#include "sim_node/run/thread_count.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <system_error>

#include <sched.h>

#include "node/assert.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/world.h"

namespace cordis::sim {
namespace {

using WallClock = std::chrono::steady_clock;

/// The shortest time of a step in some windows.
WallClock::duration step_time(engine::World& world) {
  constexpr auto kAllWindows = std::chrono::milliseconds(50);
  constexpr int kStepsOfWindow = 10;
  auto shortest = WallClock::duration::max();
  const auto begin = WallClock::now();
  auto now = begin;
  while (now - begin < kAllWindows) {
    const auto window = now;
    for (int n = 0; n < kStepsOfWindow; ++n) world.step();
    now = WallClock::now();
    shortest = std::min(shortest, now - window);
  }
  return shortest;
}

}  // namespace

std::size_t usable_core_count() noexcept {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return 1;
  return static_cast<std::size_t>(std::max(1, CPU_COUNT(&cores)));
}

std::size_t fastest_thread_count(const std::shared_ptr<const engine::Network>& network,
                                 std::size_t most) {
  CORDIS_ASSERT(network != nullptr);
  if (most < 2) return 1;
  engine::World world(network);
  most = std::min(most, world.block_count());
  if (most < 2) return 1;
  std::size_t fastest = 1;
  auto shortest = step_time(world);
  for (std::size_t count = 2; count <= most; count *= 2) {
    try {
      world.share_steps(std::make_shared<engine::ThreadTeam>(count));
    } catch (const std::system_error&) {
      break;  // the system gives no more threads
    }
    const auto time = step_time(world);
    if (time * 10 >= shortest * 9) continue;
    shortest = time;
    fastest = count;
  }
  return fastest;
}

}  // namespace cordis::sim
