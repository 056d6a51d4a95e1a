// sim_node/realtime_loop.cpp
#include "sim_node/realtime_loop.h"

#include <spdlog/spdlog.h>

#include "node/paced_loop.h"
#include "node/tick_cost.h"
#include "node/time.h"
#include "sim_node/arrival_pace.h"
#include "sim_node/engine/core/thread_team.h"

namespace cordis::sim {
namespace {

constexpr std::int64_t kFollowed = 250'000'000;  // devices follow another pace within [ns]

/// Ticks per second of real time.
double pace_of(const SceneLoop& loop) noexcept {
  return loop.simulation().scene().gesture_rate_hz * loop.time_scale();
}

}  // namespace

void run_realtime(SceneLoop& loop, node::StatusPublisher& status) {
  const node::RealtimeGrant grant = node::make_realtime(node::kLoopPriority);
  spdlog::info("real-time priority {}, memory {}",
               grant.fifo ? "granted" : "not permitted, going on without",
               grant.memory_locked ? "locked" : "not locked");
  loop.simulation().world().team().run([](std::size_t member) noexcept {
    if (member > 0) node::make_realtime(node::kLoopPriority);
  });
  ArrivalPace pace(pace_of(loop));
  std::int64_t changed_nsec = node::monotonic_nsec() - kFollowed;  // the pace, last
  const node::TickCost cost;
  std::uint64_t ticks = 0;
  while (!loop.finished()) {
    if (loop.time_scale() != 1.0 && loop.devices().real_devices().are_played()) {
      loop.set_time_scale(1.0);
      status.publish_now();
      spdlog::info("a device with motors plays: slow motion ends");
    }
    if (pace.rate_hz() != pace_of(loop)) {
      pace.restart(pace_of(loop));
      loop.devices().set_time_scale(loop.time_scale());
      changed_nsec = node::monotonic_nsec();
    }
    const std::optional<node::LateCause> late =
        pace.wait(loop.simulation(), loop.devices(), loop.inputs());
    if (!late) {
      // The period is long, and requests do not wait for its end.
      const bool has_request = loop.mailbox().waiting() != nullptr;
      if (has_request) loop.execute();
      if (has_request) pace.begin_again();
      continue;
    }
    loop.status().late_ticks().count(*late);
    if (loop.finished()) break;
    ++ticks;
    const bool plays = loop.execute();
    if (!plays) loop.inputs().hold();
    const bool complete = plays && loop.play();
    const bool is_followed = node::monotonic_nsec() - changed_nsec > kFollowed;
    if (is_followed && loop.simulation().misses_a_device())
      loop.status().late_ticks().count_silent();
    // Answers first: the hand waits for them, and the display does not.
    loop.devices().answer_received(loop.simulation());
    if (plays) loop.show(complete);
    const Simulation& simulation = loop.simulation();
    loop.runner().loaded_scene().shadow->hand_over(simulation.world(),
                                                   simulation.largest_kinetic_energy());
  }
  if (ticks > 0) spdlog::info("{}", cost.text(ticks));
}

}  // namespace cordis::sim
