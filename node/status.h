// node/status.h -- what a node says about itself, twice a second.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <semaphore>
#include <string>
#include <thread>

#include "idl/control.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "node/repeated_event.h"
#include "node/tick_rate.h"

namespace cordis::node {

/// Publishes node/status at 2 Hz from a thread of its own, and once more when it ends.
class StatusPublisher {
 public:
  /// Fills in phase, text, rates, counters, latency, energy and hash. Called from the publisher's
  /// thread twice a second; must not block. Name, kind, epoch, time, memory and the reached and
  /// the mean rate (from `ticks`) are filled in already.
  using Fill = std::function<void(msg::NodeStatus&)>;

  /// What the publisher's thread does 25 times a second, between two messages; must not block.
  using Watch = std::function<void()>;

  /// @param for_loop  the participant of the node's force loop, whose topics may not fit those of
  /// other processes either; null: the node has none
  StatusPublisher(dds::Participant& participant, msg::NodeKind kind, std::uint64_t epoch, Fill fill,
                  Watch watch = nullptr, const dds::Participant* for_loop = nullptr);

  /// Publishes the last status, not before others can have found this node, and waits a moment
  /// until it has arrived: 0.8 s after a run of no time at worst.
  ~StatusPublisher();
  StatusPublisher(const StatusPublisher&) = delete;
  StatusPublisher& operator=(const StatusPublisher&) = delete;

  /// Publishes at once, beside the regular rhythm: for a change of phase. The mean rate leaves out
  /// pauses, and is exact where this says when they begin and end. Real time: wakes the publisher's
  /// thread, takes no lock.
  void publish_now() noexcept;
  /// Publishes at once, and returns when DDS has sent a status whose figures are of now: whatever
  /// happens to this process then, others have it. For no loop; while the publisher lives.
  void publish_and_wait() noexcept;

 private:
  void loop();
  bool wait_until(std::chrono::steady_clock::time_point next);
  void publish();
  void report_mismatch();
  void report_rejoin();

  const dds::Participant& participant_;
  const dds::Participant* for_loop_;
  std::string mismatch_;
  RepeatedEvent mismatches_{"this node did not fit other processes of the session"};
  RepeatedEvent rejoins_{"processes that DDS had dropped were there again"};
  std::uint64_t rejoin_count_ = 0;  // reported
  dds::Writer<msg::NodeStatus> writer_;
  Fill fill_;
  Watch watch_;
  msg::NodeStatus status_;
  std::chrono::steady_clock::time_point begun_;
  TickRate rate_;
  double target_rate_hz_ = 0.0;  // published last
  bool was_paused_ = false;      // likewise
  std::counting_semaphore<> wake_{0};
  std::atomic<std::uint64_t> begun_count_{0};  // of publish()
  std::atomic<std::uint64_t> sent_count_{0};   // likewise
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::node
