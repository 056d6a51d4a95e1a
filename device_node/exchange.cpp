// device_node/exchange.cpp
#include "device_node/exchange.h"

#include <algorithm>
#include <utility>

namespace cordis::device {
namespace {

// Limits of a stall of the loop itself, safely below the watchdog of 20 ms that boards have.
constexpr double kStandstill = 0.018;       // [s]
constexpr double kStandstillPeriods = 1.9;  // of a slow device

}  // namespace

Exchange::Exchange(const DeviceConfig& config, Role role, Series series, bool lockstep,
                   Driver& driver, GestureChannel& channel, LoopMeter& meter, ClockFunction clock,
                   ClockFunction since_boot)
    : config_(config),
      role_(role),
      lockstep_(lockstep),
      driver_(driver),
      channel_(channel),
      meter_(meter),
      clock_(clock),
      since_boot_(since_boot != nullptr ? since_boot : clock),
      force_guard_(config.force_guard),
      position_guard_(config.position_guard),
      late_(static_cast<std::size_t>(config.limits.delay_periods) + 1),
      first_sample_(series.last_sample + 1),
      begun_nsec_(clock()),
      lived_nsec_(since_boot_()) {
  sample_.epoch = series.epoch;
  sample_.sample = series.last_sample;
  sample_.axis_count = static_cast<std::uint32_t>(config.end_piece.coordinate_count());
  meter_.set_phase(Phase::kWaiting);
  driver_.start(role_);
  present_ = driver_.read(sensed_) && all_finite(sensed_, kMaxAxes);
  if (present_) last_sensed_ = sensed_;
  sensed_ = last_sensed_;
}

Exchange::~Exchange() {
  driver_.stop();
}

void Exchange::send_sample() noexcept {
  if (!present_ && !lockstep_) return;
  ++sample_.sample;
  sample_.answered_epoch = applied_.epoch;
  sample_.answered_sample = applied_.sample;
  sample_.answered_time_nsec = applied_.time_nsec;
  sample_.value = role_ == Role::kMass ? config_.end_piece.coordinates_of(sensed_)
                                       : config_.end_piece.coordinate_forces_of(sensed_);
  sample_.time_nsec = clock_();
  if (!channel_.send(sample_)) meter_.count_dropped();
}

void Exchange::repeat_sample() noexcept {
  if (!channel_.send(sample_)) meter_.count_dropped();
}

void Exchange::receive() noexcept {
  GestureMessage answer;
  while (channel_.receive(answer, std::chrono::nanoseconds(0))) consider(answer);
}

bool Exchange::await_answer(std::chrono::nanoseconds silence) noexcept {
  GestureMessage answer;
  while (channel_.receive(answer, silence)) {
    if (consider(answer)) return true;  // all samples before this one have been answered
  }
  return false;
}

void Exchange::let_go() noexcept {
  if (!driver_.has_motors()) return;
  driver_.let_go();
  force_guard_.let_go();
}

void Exchange::leave() noexcept {
  const ForceGuardSettings& guard = config_.force_guard;
  leaving_age_s_ = std::max(age_s(), guard.watchdog_s - guard.limit_n / guard.slew_n_per_s);
}

/// True if an answer is well formed, answers this process, and is newer than the one in use.
/// A new epoch of the scene is recognised by what it answers alone.
bool Exchange::consider(const GestureMessage& answer) noexcept {
  if (answer.answered_epoch == 0) return false;  // the scene has not received this device yet
  if (answer.answered_epoch != sample_.epoch) {
    other_answered_ = true;
    other_answered_nsec_ = clock_();
    return false;
  }
  const bool well_formed = answer.axis_count >= 1 && answer.axis_count <= kMaxAxes &&
                           answer.answered_time_nsec >= begun_nsec_ &&
                           answer.answered_time_nsec <= clock_();
  const bool answers_us =
      answer.answered_sample >= first_sample_ && answer.answered_sample <= sample_.sample;
  // Between two samples of this device the scene may answer twice: the later answer counts.
  const bool later = answer.epoch != used_.epoch || answer.sample > used_.sample;
  const bool newer = !any_answer_ || answer.answered_sample > used_.answered_sample ||
                     (answer.answered_sample == used_.answered_sample && later && !lockstep_);
  if (!well_formed || !answers_us || !newer) {
    meter_.count_dropped();
    return false;
  }
  accept(answer);
  return true;
}

void Exchange::accept(const GestureMessage& answer) noexcept {
  if (!any_answer_ || answer.answered_sample > used_.answered_sample) {
    unapplied_ = true;
    unanswered_periods_ = 0;
  }
  any_answer_ = true;
  used_ = answer;
  late_[answer.answered_sample % late_.size()] = answer;
  // The ring holds the delay and one more: the next to be replaced is the oldest.
  applied_ = lockstep_ ? late_[(answer.answered_sample + 1) % late_.size()] : answer;
  const bool finite = role_ == Role::kMass
                          ? force_guard_.accept(config_.end_piece.axis_forces_of(applied_.value))
                          : position_guard_.accept(config_.end_piece.axes_of(applied_.value));
  if (!finite) meter_.count_dropped();
}

double Exchange::age_s() const noexcept {
  if (lockstep_) {
    return static_cast<double>(sample_.sample - used_.answered_sample) / config_.layout.rate_hz;
  }
  return static_cast<double>(clock_() - used_.answered_time_nsec) * 1e-9;
}

bool Exchange::stood_still() noexcept {
  const std::int64_t now = since_boot_();
  const auto since_s = static_cast<double>(now - std::exchange(lived_nsec_, now)) * 1e-9;
  return !lockstep_ && since_s > std::max(kStandstill, kStandstillPeriods / config_.layout.rate_hz);
}

/// Work of a hand that was carried, its force known before and after: f dx, exact for one that is a
/// spring. At the end of the travel the scene goes on under the force of a hand that cannot: that
/// counts as if it did, for it is not the age of the force that makes the difference.
void Exchange::add_work(const AxisValues& force_before_n, const AxisValues& carried_m) noexcept {
  const AxisValues& beyond_m = position_guard_.beyond_m();
  for (std::size_t a = 0; a < carried_m.size(); ++a) {
    const double where_m = carried_m[a] + beyond_m[a];
    const double before_m = std::exchange(carried_[a], where_m);
    if (is_carried_)
      sample_.work_j += 0.5 * (force_before_n[a] + sensed_[a]) * (where_m - before_m);
  }
  is_carried_ = true;
}

void Exchange::live() noexcept {
  const bool leaving = leaving_age_s_ > 0.0;
  if (leaving) {
    leaving_s_ += 1.0 / config_.layout.rate_hz;
    leaving_age_s_ += 1.0 / config_.layout.rate_hz;
  }
  const double least = stood_still() ? config_.force_guard.watchdog_s : leaving_age_s_;
  const double age = std::max(age_s(), least);
  const AxisValues& commanded =
      role_ == Role::kMass ? force_guard_.tick(age, sensed_) : position_guard_.tick(age);
  driver_.record_age(age);
  const bool written = driver_.write(commanded);
  if (std::exchange(unapplied_, false)) meter_.record_latency(clock_() - used_.answered_time_nsec);
  const bool sensed = driver_.read(sensed_) && all_finite(sensed_, config_.layout.count);
  if (!sensed) sensed_ = last_sensed_;  // a hand does not jump
  if (role_ == Role::kLiaison) add_work(last_sensed_, commanded);
  last_sensed_ = sensed_;
  meter_.count_tick();
  const PassivityObserver& monitor = force_guard_.energy();
  meter_.record_energy(role_ == Role::kMass ? monitor.given_j() : -sample_.work_j,
                       role_ == Role::kMass && monitor.is_damping());

  present_ = written && sensed;
  if (!present_) force_guard_.let_go();  // a device that comes back is ramped up again
  if (!leaving) record_phase(any_answer_ && age < config_.force_guard.watchdog_s);
}

void Exchange::record_phase(bool in_time) noexcept {
  const double since_other_s = static_cast<double>(clock_() - other_answered_nsec_) * 1e-9;
  const bool other = other_answered_ && since_other_s < config_.force_guard.watchdog_s;
  const double unanswered_s = static_cast<double>(++unanswered_periods_) / config_.layout.rate_hz;
  misses_scene_ =
      present_ && any_answer_ && !other && unanswered_s > config_.force_guard.watchdog_s;
  if (present_ && in_time) {
    meter_.set_phase(Phase::kRunning);
  } else if (present_ && other) {
    meter_.set_phase(Phase::kStandby);
  } else if (!present_ || any_answer_) {
    meter_.set_phase(driver_.is_let_go() ? Phase::kDisconnected : Phase::kLost);
  }
}

}  // namespace cordis::device
