// device_node/loop_meter.h -- what the loop of a device counts, for node/status.
#pragma once

#include <atomic>
#include <cstdint>

#include "idl/control.h"
#include "node/late_ticks.h"
#include "node/latency.h"

namespace cordis::device {

/// How a device stands with the scene.
enum class Phase : std::uint8_t {
  kWaiting,         ///< no scene or no answer has been received yet; motors off
  kUnused,          ///< the scene does not name the device; motors off
  kRunning,         ///< answers come in time
  kStandby,         ///< the scene answers another node that plays the same device; motors off
  kLost,            ///< answers no longer come, or the driver has no device; motors at zero
  kDisconnected,    ///< the board or the guardian has let go of the motors
  kStopped,         ///< the node is ending as it was asked to
  kNeverConnected,  ///< likewise, and the driver has never had its device
  kReplaced,        ///< likewise; another node has played it
  kTaken            ///< likewise; another process drives it
};

/// Counters of one device. The loop thread writes; fill() may be called from another thread.
class LoopMeter {
 public:
  void set_phase(Phase phase) noexcept { phase_.store(phase, std::memory_order_relaxed); }
  Phase phase() const noexcept { return phase_.load(std::memory_order_relaxed); }

  /// After a tick. @param has_device  the driver has its device. @param other_plays  the scene answers
  /// another node that plays it. @param is_taken  another process drives the device
  void record_device(bool has_device, bool other_plays, bool is_taken = false) noexcept;

  /// The phase of a node that ends as it was asked to: kStopped, unless the driver has looked for its
  /// device and never had it.
  Phase last_phase() const noexcept;

  void count_tick() noexcept;
  void count_dropped() noexcept { dropped_.fetch_add(1, std::memory_order_relaxed); }
  node::LateTicks& late_ticks() noexcept { return late_ticks_; }

  /// After a tick: the energy given to the hand, and whether the motors damped it.
  void record_energy(double given_j, bool damping) noexcept;

  /// From the sending of a sample to the arrival of its answer.
  void record_latency(std::int64_t nsec) noexcept { latency_.record(nsec); }

  /// An answer has come to the sample `step` numbers after the one answered before: those between
  /// them have none. @param step  1 for the first answer
  void record_answer(std::uint64_t step) noexcept;

  /// Makes the latencies recorded so far visible to fill(); every 256th tick does so by itself.
  void publish_latency() noexcept;

  /// Phase, counters and latency. The text says in a sentence what the phase means.
  void fill(msg::NodeStatus& status) const;

  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  std::uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_relaxed); }

 private:
  std::atomic<Phase> phase_{Phase::kWaiting};
  std::atomic<bool> is_sought_{false};  // there has been a tick
  std::atomic<bool> was_connected_{false};
  std::atomic<bool> was_replaced_{false};  // by another node
  std::atomic<bool> is_taken_{false};      // by another process
  std::atomic<std::uint64_t> ticks_{0};
  node::LateTicks late_ticks_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<double> given_j_{0.0};
  std::atomic<std::uint64_t> passivity_ticks_{0};
  node::LatencyHistogram latency_;  // of the loop thread alone
  std::atomic<std::uint64_t> link_samples_{0};
  std::atomic<std::uint64_t> link_unanswered_{0};
  std::atomic<std::uint64_t> latency_count_{0};
  std::atomic<double> latency_p50_s_{0.0};
  std::atomic<double> latency_p99_s_{0.0};
  std::atomic<double> latency_max_s_{0.0};
};

}  // namespace cordis::device
