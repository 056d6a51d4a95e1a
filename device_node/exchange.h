// device_node/exchange.h -- one device against one scene: sample out, answer in, motors, sensors.
#pragma once

#include <chrono>
#include <cstdint>

#include "device_node/answer_filter.h"
#include "device_node/device_config.h"
#include "device_node/gesture_channel.h"
#include "device_node/hand_work.h"
#include "device_node/loop_meter.h"
#include "device_node/stall_watch.h"

namespace cordis::device {

/// The force loop of a device in one role, without its pace. In lockstep one period is
///   send_sample();  await_answer() until the very sample is answered;  step();
/// Here step() guards what was answered, and hands it to the driver. It lets the driver act for a
/// period, and reads its sensors for the next sample.
///
/// In real time one period is play_period(), at its beginning, and use_late_answer(), for its rest.
/// When the driver changes its command within a period, the sensors are read and sent at once, and
/// each answer goes to the motors as soon as it comes. For kAnswerShare of the period the motors wait
/// for that to the very sample; then the guard does what it does without one. A position that comes
/// later waits for the next period. Of other drivers a period is step() with the newest answer, and then send_sample().
///
/// Between the axes and the wire stands the end-effector map of the device; the guard stands behind
/// it, at the motors. In lockstep `delay_periods` of the device lets every answer reach the motors
/// so much later, as over a slow wire. Samples echo what has reached them. The age of what goes to
/// the guard is counted in samples, and nothing depends on wall time. Otherwise the age counts from
/// the moment the answered sample was sent, so that a scene that no longer receives this device
/// counts as silent. A loop that has itself stalled for 18 ms, or nearly two periods, restarts
/// whatever the watchdog. It also does after a sleep of the machine, in which nothing ages. By then
/// a device may have let go on its own (docs/kfb1.md).
class Exchange {
 public:
  using ClockFunction = StallWatch::ClockFunction;  ///< CLOCK_MONOTONIC [ns]

  /// What identifies the samples of this process.
  struct Series {
    std::uint64_t epoch = 0;        ///< epoch of this process
    std::uint64_t last_sample = 0;  ///< number of the last sample sent before
  };

  /// What an exchange works with and on. All that is referred to must outlive the exchange.
  struct Setup {
    const DeviceConfig& config;
    Driver& driver;
    GestureChannel& channel;
    LoopMeter& meter;
    Role role = Role::kMass;
    Series series{};
    bool lockstep = false;
    ClockFunction clock;
    /// A clock that goes on while the machine sleeps; nullptr: `clock`, which stops.
    ClockFunction since_boot = nullptr;
    /// After which slow motion repeats the sample, so that no standby takes over; 0: never.
    std::int64_t repeat_nsec = 0;
  };

  /// Starts the driver in the role.
  explicit Exchange(const Setup& setup);

  /// Stops the driver.
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  static constexpr double kAnswerShare = 0.5;  ///< part of a period in which the motors wait

  /// The newest readings, under the next number; nothing while the driver has no device, so that
  /// another node may play it. In lockstep the last ones then, since a scene waits for them.
  void send_sample() noexcept;
  void repeat_sample() noexcept;  ///< sends the same message once more

  /// Takes all answers that are there. What the filter refuses is counted as dropped.
  void receive() noexcept;

  /// Waits until the sample sent last is answered, or `silence` has passed since the newest
  /// answer or call; true when it is answered.
  bool await_answer(std::chrono::nanoseconds silence) noexcept;

  /// Between two periods, in real time: from now on simulated time passes so many times as fast as
  /// real time, and the caller makes its periods longer. Every age and span counts in simulated time.
  /// Until the scene answers a sample of the new pace, the slower of the two counts.
  /// Precondition: scale is 1, or between 0 and 1 and there are no motors.
  void set_time_scale(double scale) noexcept;

  /// In slow motion, between two periods: sends the sample again where it is to be repeated.
  void hold_port() noexcept;

  /// Real time: plays a period from its beginning on, until its answer is at the motors, or
  /// kAnswerShare of it are over.
  void play_period() noexcept;

  /// Real time, after play_period(): hands the motors an answer that comes before that moment, if
  /// the driver takes it. Returns when no other can come. @param until_nsec  CLOCK_MONOTONIC
  void use_late_answer(std::int64_t until_nsec) noexcept;

  /// In lockstep, once for each period in which await_answer() has been in vain: the newest answer ages,
  /// and the motors get what is left of it, as in step().
  void age_answer() noexcept;

  /// Motors, one period, sensors. Sets the phase of the meter. It is waiting until the first
  /// answer, running while answers come, and standby while they go to another node. It is lost when
  /// they are older than the watchdog, or the driver has no device. It is disconnected when the
  /// motors have been let go of outside this loop.
  void step() noexcept;

  bool has_device() const noexcept { return present_; }  ///< true if the driver has one
  /// True if it has none because another process drives it.
  bool is_taken() const noexcept { return !present_ && driver_.is_taken(); }
  /// True if the scene has fallen silent: it answered this exchange, for longer than the watchdog
  /// it has answered no new sample, and no other node gets the answers. Counted in periods: one in
  /// which this loop stalled is not the scene's.
  bool misses_the_scene() const noexcept { return misses_scene_; }
  bool has_motors() const noexcept { return driver_.has_motors(); }

  /// The part is over: motors are not switched off in the middle of a force. From now on nothing is
  /// taken any more. With every step() the last answer fades as an old one does, over limit / slew.
  /// The fade lasts no longer than 0.5 s, for a stop is a stop.
  void leave() noexcept;
  bool has_left() const noexcept {
    return leaving_age_s_ >= config_.force_guard.watchdog_s || leaving_s_ >= kLongestLeave;
  }

  std::uint64_t last_sample() const noexcept { return sample_.sample; }

 private:
  static constexpr double kLongestLeave = 0.5;  // [s]

  void begin_period() noexcept;
  void apply_answers_until(std::int64_t nsec) noexcept;
  void apply() noexcept;
  bool is_answered() const noexcept { return answers_.has_answered(sample_.sample); }
  double share_now() const noexcept;
  double simulated_s(std::int64_t since_nsec) const noexcept;
  /// True if slow motion repeats samples.
  bool repeats() const noexcept { return repeat_nsec_ > 0 && time_scale_ < 1.0; }
  double age_for_guard() noexcept;
  double since_command_s() noexcept;
  const AxisValues& command(double age_s, double share, double since_s) noexcept;
  void record_application() noexcept;
  bool sense() noexcept;
  void end_tick(double age_s) noexcept;

  bool consider(const GestureMessage& answer) noexcept;
  double age_s() const noexcept;
  void add_work(const AxisValues& force_before_n) noexcept;
  void record_phase(bool in_time) noexcept;

  const DeviceConfig& config_;
  Role role_;
  bool lockstep_;
  Driver& driver_;
  GestureChannel& channel_;
  LoopMeter& meter_;
  ClockFunction clock_;
  const std::int64_t repeat_nsec_;
  StallWatch stalls_;
  ForceGuard force_guard_;
  PositionGuard position_guard_;
  GestureMessage sample_;            // the sample sent last
  GestureMessage commanded_answer_;  // that which the newest command follows from
  AxisValues commanded_{};           // the newest command
  bool is_commanded_ = false;        // there has been any
  bool written_ = true;              // the driver has taken it
  bool is_ticked_ = false;           // real time: the guard has ticked in this period
  double ticked_age_s_ = 0.0;        // of the answer that it was given [s]
  AxisValues sensed_{};              // for the next sample
  AxisValues last_sensed_{};         // all finite
  std::int64_t sensed_nsec_;         // when the sensors were read last
  AnswerFilter answers_;
  HandWork work_;                    // role liaison
  std::int64_t commanded_nsec_ = 0;  // when the motors got a command within a period
  double time_scale_ = 1.0;          // of the periods
  double age_scale_ = 1.0;           // of what began before the present moment
  std::uint64_t paced_from_ = 0;     // first sample of the present pace
  double waited_s_ = 0.0;            // in lockstep: since the sample was sent, in whole periods
  double leaving_s_ = 0.0;           // since leave()
  double leaving_age_s_ = 0.0;       // that the last answer is given; 0: it has its own
  bool present_ = false;             // the driver has its device
  bool misses_scene_ = false;
  std::int64_t unanswered_periods_ = 0;  // since an answer to a new sample
  bool pending_ = false;                 // the newest answer has not been handed to the driver yet
  bool unapplied_ = false;               // and it is the first to its sample
};

}  // namespace cordis::device
