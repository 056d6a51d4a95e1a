// device_node/exchange.h -- one device against one scene: sample out, answer in, motors, sensors.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "device_node/device_config.h"
#include "device_node/gesture_channel.h"
#include "device_node/loop_meter.h"

namespace cordis::device {

/// The force loop of a device in one role, without its pace. One period is
///   send_sample();  receive() or await_answer();  live();
/// in the realtime clock with a sleep before receive(), in lockstep with await_answer() until the
/// very sample has its answer. Then live() guards what was answered, hands it to the driver, lets
/// the driver live for a period and reads its sensors for the next sample.
///
/// Between the axes and the wire stands the end-piece of the device; the guard stands behind it, at
/// the motors. In lockstep `delay_periods` of the device lets every answer be felt so much later,
/// as over a slow wire, and samples echo what is felt; the age of what goes to the guard is counted
/// in samples, and nothing depends on wall time. Otherwise the age counts from the moment the
/// answered sample was sent, so that a scene that no longer receives this device counts as silent.
/// A loop that has itself stalled for 18 ms, or nearly two periods, restarts whatever the watchdog,
/// and so after a sleep of the machine, in which nothing ages: by then a device may have let go on
/// its own (docs/kfb1.md).
class Exchange {
 public:
  using ClockFunction = std::int64_t (*)() noexcept;  ///< CLOCK_MONOTONIC [ns]

  /// What identifies the samples of this process.
  struct Series {
    std::uint64_t epoch = 0;        ///< of this process
    std::uint64_t last_sample = 0;  ///< number of the last sample sent before
  };

  /// Starts the driver in the role. What is referred to must outlive the exchange.
  /// @param since_boot  a clock that goes on while the machine sleeps; nullptr: `clock`, which
  /// stops
  Exchange(const DeviceConfig& config, Role role, Series series, bool lockstep, Driver& driver,
           GestureChannel& channel, LoopMeter& meter, ClockFunction clock,
           ClockFunction since_boot = nullptr);

  /// Stops the driver.
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  /// The newest readings, under the next number; nothing while the driver has no device, so that
  /// another node may play it. In lockstep the last ones then, since a scene waits for them.
  void send_sample() noexcept;
  void repeat_sample() noexcept;  ///< the same message once more

  /// Takes all answers that are there. Bad, foreign and outdated ones are counted as dropped, and
  /// those that echo what this exchange has not sent: whoever takes part in the session may write
  /// an answer, and no number of it is trusted.
  void receive() noexcept;

  /// Waits until the sample sent last is answered, or `silence` has passed since the newest
  /// answer or call; true when it is answered.
  bool await_answer(std::chrono::nanoseconds silence) noexcept;

  /// In lockstep, when await_answer() has been in vain: motors off, if there are any.
  void let_go() noexcept;

  /// Motors, one period, sensors. Sets the phase of the meter: waiting until the first answer,
  /// running while answers come, standby while they go to another node, lost when they are older
  /// than the watchdog or the driver has no device, disconnected when its motors have been let go
  /// of outside this loop.
  void live() noexcept;

  bool has_device() const noexcept { return present_; }  ///< whether the driver has one
  /// True if the scene has fallen silent: it answered this exchange, for longer than the watchdog
  /// it has answered no new sample, and no other node gets the answers. Counted in periods: one in
  /// which this loop stalled is not the scene's.
  bool misses_the_scene() const noexcept { return misses_scene_; }
  bool has_motors() const noexcept { return driver_.has_motors(); }

  /// The part is over: motors are not switched off in the middle of a force. From now on nothing is
  /// taken any more, and with every live() the last answer fades as an old one does, over
  /// limit / slew; but not for longer than 0.5 s, for a stop is a stop.
  void leave() noexcept;
  bool has_left() const noexcept {
    return leaving_age_s_ >= config_.force_guard.watchdog_s || leaving_s_ >= kLongestLeave;
  }

  std::uint64_t last_sample() const noexcept { return sample_.sample; }

 private:
  static constexpr double kLongestLeave = 0.5;  // [s]

  bool consider(const GestureMessage& answer) noexcept;
  void accept(const GestureMessage& answer) noexcept;
  double age_s() const noexcept;
  bool stood_still() noexcept;
  void add_work(const AxisValues& force_before_n, const AxisValues& carried_m) noexcept;
  void record_phase(bool in_time) noexcept;

  const DeviceConfig& config_;
  Role role_;
  bool lockstep_;
  Driver& driver_;
  GestureChannel& channel_;
  LoopMeter& meter_;
  ClockFunction clock_;
  ClockFunction since_boot_;
  ForceGuard force_guard_;
  PositionGuard position_guard_;
  GestureMessage sample_;                 // the sample sent last
  GestureMessage used_;                   // the newest good answer
  GestureMessage applied_;                // that which goes to the motors: older with a delay
  AxisValues sensed_{};                   // for the next sample
  AxisValues last_sensed_{};              // all finite
  std::vector<GestureMessage> late_;      // the last answers, by the sample they answer
  AxisValues carried_{};                  // role liaison: where the hand is, or would be [m]
  bool is_carried_ = false;               // it is anywhere yet
  std::uint64_t first_sample_;            // of this exchange
  std::int64_t begun_nsec_;               // when it began
  std::int64_t other_answered_nsec_ = 0;  // when an answer to another node came
  bool other_answered_ = false;           // ever
  std::int64_t lived_nsec_;               // when live() was called last
  double leaving_s_ = 0.0;                // since leave()
  double leaving_age_s_ = 0.0;            // that the last answer is given; 0: it has its own
  bool present_ = false;                  // the driver has its device
  bool any_answer_ = false;
  bool misses_scene_ = false;
  std::int64_t unanswered_periods_ = 0;  // since an answer to a new sample
  bool unapplied_ = false;               // the newest answer has not been handed to the driver yet
};

}  // namespace cordis::device
