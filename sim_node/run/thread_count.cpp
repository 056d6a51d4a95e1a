// sim_node/run/thread_count.cpp
#include "sim_node/run/thread_count.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "node/config/count_text.h"
#include "sim_node/engine/core/thread_team.h"

namespace cordis::sim {
namespace {

using WallClock = std::chrono::steady_clock;

/// The mean time of a step [s]. What disturbs the threads counts: it will go on doing so.
double step_time(engine::World& world) {
  constexpr auto kMeasured = std::chrono::milliseconds(50);
  const auto begin = WallClock::now();
  auto now = begin;
  int steps = 0;
  while (now - begin < kMeasured) {
    world.step();
    ++steps;
    now = WallClock::now();
  }
  return std::chrono::duration<double>(now - begin).count() / steps;
}

SharedSteps fastest_of(const engine::World& world, std::size_t most) {
  engine::World tried(world.shared_network());
  SharedSteps fastest;
  double shortest = step_time(tried);
  std::string times = fmt::format("a step takes {:.3g} ms with 1 thread", 1e3 * shortest);
  for (std::size_t count = 2; count <= most; count *= 2) {
    try {
      tried.share_steps(std::make_shared<engine::ThreadTeam>(count));
    } catch (const std::system_error&) {
      break;  // the system gives no more threads
    }
    const double time = step_time(tried);
    times += fmt::format(", {:.3g} ms with {}", 1e3 * time, count);
    if (time > 0.9 * shortest) continue;
    shortest = time;
    fastest.threads = count;
  }
  fastest.text =
      times + (fastest.threads > 1 ? fmt::format("; {} threads share it", fastest.threads)
                                   : "; one thread does it");
  return fastest;
}

SharedSteps choose(const engine::World& world, std::size_t threads, std::size_t most) {
  const std::size_t parts = world.block_count();
  if (threads == kFastest) {
    most = std::min(most, parts);
    return most > 1 ? fastest_of(world, most) : SharedSteps{};
  }
  SharedSteps shared{std::min(threads, parts), ""};
  if (threads == 1) return shared;
  shared.text = "a step is shared by " + config::count_text(shared.threads, "thread");
  if (parts == 1) shared.text = "one thread does each step: it cannot be taken apart";
  return shared;
}

}  // namespace

SharedSteps share_steps(engine::World& world, std::size_t threads, std::size_t most) {
  SharedSteps shared = choose(world, threads, most);
  try {
    world.share_steps(std::make_shared<engine::ThreadTeam>(shared.threads));
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("the system does not give {} threads: {}", shared.threads, error.what()));
  }
  return shared;
}

std::size_t max_threads_beside(std::size_t nodes, std::size_t processors) noexcept {
  return processors > nodes ? processors - nodes : 1;
}

}  // namespace cordis::sim
