// sim_node/realtime_loop.cpp
#include "sim_node/realtime_loop.h"

#include <spdlog/spdlog.h>

#include "node/paced_loop.h"
#include "node/tick_cost.h"
#include "sim_node/arrival_pace.h"

namespace cordis::sim {
namespace {

constexpr int kLoopPriority = 80;

}  // namespace

void run_realtime(SceneLoop& loop) {
  const node::RealtimeGrant grant = node::make_realtime(kLoopPriority);
  spdlog::info("real-time priority {}, memory {}",
               grant.fifo ? "granted" : "not permitted, going on without",
               grant.memory_locked ? "locked" : "not locked");
  ArrivalPace pace(loop.simulation().scene().gesture_rate_hz);
  const node::TickCost cost;
  std::uint64_t ticks = 0;
  while (!loop.finished()) {
    loop.status().late_ticks().count(pace.wait(loop.simulation(), loop.devices(), loop.inputs()));
    if (loop.finished()) break;
    ++ticks;
    const bool plays = loop.execute();
    if (pace.rate_hz() != loop.simulation().scene().gesture_rate_hz)
      pace.restart(loop.simulation().scene().gesture_rate_hz);
    if (!plays) loop.inputs().hold();
    const bool complete = plays && loop.play();
    if (loop.simulation().misses_a_device()) loop.status().late_ticks().count_silent();
    // Answers first: the hand waits for them, and the display does not.
    loop.devices().answer_received(loop.simulation());
    if (plays) loop.show(complete);
    loop.runner().loaded_scene().shadow->hand_over(loop.simulation().world());
  }
  if (ticks > 0) spdlog::info("{}", cost.text(ticks));
}

}  // namespace cordis::sim
