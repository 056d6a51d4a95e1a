// sim_node/run/thread_count.cpp
#include "sim_node/run/thread_count.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>

#include "sim_node/engine/core/thread_team.h"

namespace cordis::sim {
namespace {

using WallClock = std::chrono::steady_clock;

/// The mean time of a step. What disturbs the threads counts: it will go on doing so.
WallClock::duration step_time(engine::World& world) {
  constexpr auto kMeasured = std::chrono::milliseconds(50);
  const auto begin = WallClock::now();
  auto now = begin;
  int steps = 0;
  while (now - begin < kMeasured) {
    world.step();
    ++steps;
    now = WallClock::now();
  }
  return (now - begin) / steps;
}

}  // namespace

std::size_t fastest_thread_count(const engine::World& world, std::size_t most) {
  most = std::min(most, world.block_count());
  if (most < 2) return 1;
  engine::World tried(world.shared_network());
  std::size_t fastest = 1;
  auto shortest = step_time(tried);
  for (std::size_t count = 2; count <= most; count *= 2) {
    try {
      tried.share_steps(std::make_shared<engine::ThreadTeam>(count));
    } catch (const std::system_error&) {
      break;  // the system gives no more threads
    }
    const auto time = step_time(tried);
    if (time * 10 >= shortest * 9) continue;
    shortest = time;
    fastest = count;
  }
  return fastest;
}

}  // namespace cordis::sim
