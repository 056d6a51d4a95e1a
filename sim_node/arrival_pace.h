// sim_node/arrival_pace.h -- the pace of a scene in real time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "node/late_ticks.h"
#include "sim_node/arrival_rule.h"
#include "sim_node/device_link.h"
#include "sim_node/run/input_log.h"
#include "sim_node/run/simulation.h"

namespace cordis::sim {

/// One tick in each gesture period: as soon as every device whose sample is due has sent it in the
/// period, or at the end of the period (ArrivalRule). A device plays from its first sample until it is
/// silent. While none plays, the clock of this host alone sets the pace.
///
/// The period follows the phase of the samples (node::PeriodGrid): a device whose clock is another
/// host's is answered on arrival as well. Of several devices the one that sends last sets the
/// phase; the others wait for it. A sample that is late or lost holds the tick until the end of the
/// period alone. One that is late is played with the next one, without an answer of its own.
class ArrivalPace {
 public:
  /// @param rate_hz  ticks per second, > 0
  explicit ArrivalPace(double rate_hz);

  /// Waits for the next tick, and receives what the devices send meanwhile. Also ends when a stop is
  /// requested. Real time: allocates nothing.
  /// @return why the tick begins a period or more after the end of its own; empty when the tick is
  ///         not due after kLongestWait: then the wait goes on with the next call
  std::optional<node::LateCause> wait(Simulation& simulation, DeviceLink& devices,
                                      InputLog& inputs);

  static constexpr std::int64_t kLongestWait = 20'000'000;  ///< longest wait of a call [ns]

  /// The devices of the scene have changed: the next wait() begins a wait.
  void begin_again() noexcept { is_waiting_ = false; }

  /// Restarts at another rate. Real time: allocates nothing.
  void restart(double rate_hz) noexcept;

  double rate_hz() const noexcept { return rule_.grid().rate_hz(); }

 private:
  bool wait_for_samples(Simulation& simulation, DeviceLink& devices, InputLog& inputs);
  std::span<const ArrivalRule::Device> sent(Simulation& simulation);

  ArrivalRule rule_;
  std::vector<ArrivalRule::Device> sent_;
  bool is_first_ = true;
  bool is_waiting_ = false;
  std::uint32_t waited_from_ = 0;          // messages when the wait began
  std::int64_t computed_nsec_ = 0;         // by the tick before
  std::int64_t begun_processor_nsec_ = 0;  // of the thread, when the present tick began
};

}  // namespace cordis::sim
