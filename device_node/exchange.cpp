// device_node/exchange.cpp
#include "device_node/exchange.h"

#include <algorithm>
#include <utility>

#include "node/assert.h"

namespace cordis::device {

Exchange::Exchange(const Setup& setup)
    : config_(setup.config),
      role_(setup.role),
      lockstep_(setup.lockstep),
      driver_(setup.driver),
      channel_(setup.channel),
      meter_(setup.meter),
      clock_(setup.clock),
      repeat_nsec_(setup.repeat_nsec),
      stalls_(setup.since_boot != nullptr ? setup.since_boot : setup.clock, config_.layout.rate_hz),
      force_guard_(config_.force_guard),
      position_guard_(config_.position_guard),
      sensed_nsec_(clock_()),
      answers_({setup.series.epoch, setup.series.last_sample + 1, sensed_nsec_}, lockstep_,
               config_.limits.delay_periods) {
  sample_.epoch = setup.series.epoch;
  sample_.sample = setup.series.last_sample;
  sample_.axis_count = static_cast<std::uint32_t>(config_.end_effector_map.coordinate_count());
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
  sample_.answered_epoch = commanded_answer_.epoch;
  sample_.answered_sample = commanded_answer_.sample;
  sample_.answered_time_nsec = commanded_answer_.time_nsec;
  sample_.value = role_ == Role::kMass ? config_.end_effector_map.coordinates_of(sensed_)
                                       : config_.end_effector_map.coordinate_forces_of(sensed_);
  sample_.time_nsec = driver_.changes_within_period() && !lockstep_ ? sensed_nsec_ : clock_();
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
    if (!consider(answer)) continue;
    waited_s_ = 0.0;
    return true;  // all samples before this one have been answered
  }
  return false;
}

void Exchange::set_time_scale(double scale) noexcept {
  CORDIS_ASSERT(scale == 1.0 || (scale > 0.0 && scale < 1.0 && !driver_.has_motors()));
  time_scale_ = scale;
  age_scale_ = std::min(age_scale_, scale);
  paced_from_ = sample_.sample + 1;
}

/// DDS gives the port to a standby 20 ms after a sample, whatever the scale.
void Exchange::hold_port() noexcept {
  const bool has_sent = sample_.sample >= paced_from_;
  if (repeats() && present_ && has_sent) repeat_sample();
}

/// Simulated time since a moment of the clock.
double Exchange::simulated_s(std::int64_t since_nsec) const noexcept {
  return static_cast<double>(clock_() - since_nsec) * 1e-9 * age_scale_;
}

void Exchange::age_answer() noexcept {
  CORDIS_ASSERT(lockstep_);
  waited_s_ += 1.0 / config_.layout.rate_hz;
  step();
}

void Exchange::leave() noexcept {
  const ForceGuardSettings& guard = config_.force_guard;
  leaving_age_s_ = std::max(age_s(), guard.watchdog_s - guard.limit_n / guard.slew_n_per_s);
}

/// Takes an answer into use. @return false when the filter leaves it
bool Exchange::consider(const GestureMessage& answer) noexcept {
  const AnswerFilter::Outcome outcome = answers_.consider(answer, sample_.sample, clock_());
  if (outcome == AnswerFilter::Outcome::kRefused) meter_.count_dropped();
  if (outcome != AnswerFilter::Outcome::kTaken) return false;
  if (answers_.newly_answered() > 0) {
    if (answer.answered_sample >= paced_from_) age_scale_ = time_scale_;
    unapplied_ = true;
    unanswered_periods_ = 0;
    meter_.record_answer(answers_.newly_answered());
  }
  pending_ = true;
  const AxisValues& value = answers_.in_use().value;
  const bool finite = role_ == Role::kMass
                          ? force_guard_.accept(config_.end_effector_map.axis_forces_of(value))
                          : position_guard_.accept(config_.end_effector_map.axes_of(value));
  if (!finite) meter_.count_dropped();
  return true;
}

double Exchange::age_s() const noexcept {
  if (lockstep_) {
    return static_cast<double>(sample_.sample - answers_.newest().answered_sample) /
           config_.layout.rate_hz;
  }
  return simulated_s(answers_.newest().answered_time_nsec);
}

/// At the end of the travel the scene goes on under the force of a hand that cannot: that counts as
/// if it did, for it is not the age of the force that makes the difference.
void Exchange::add_work(const AxisValues& force_before_n) noexcept {
  AxisValues where_m = commanded_;
  const AxisValues& beyond_m = position_guard_.beyond_m();
  for (std::size_t a = 0; a < where_m.size(); ++a) where_m[a] += beyond_m[a];
  work_.carry(where_m, force_before_n, sensed_);
  sample_.work_j = work_.work_j();
}

/// The age of the newest answer as the guards count it; also counts the time since leave().
double Exchange::age_for_guard() noexcept {
  if (leaving_age_s_ > 0.0) {
    leaving_s_ += 1.0 / config_.layout.rate_hz;
    leaving_age_s_ += 1.0 / config_.layout.rate_hz;
  }
  const double least = stalls_.has_stalled(age_scale_) && !lockstep_
                           ? config_.force_guard.watchdog_s
                           : leaving_age_s_;
  return std::max(age_s() + waited_s_, least);
}

/// How long ago the command before went to motors that take one at any time.
double Exchange::since_command_s() noexcept {
  const double since_s = simulated_s(commanded_nsec_);
  commanded_nsec_ = clock_();
  return is_commanded_ ? since_s : ForceGuard::kWholePeriod;
}

/// What the guard makes of the newest answer. @param share  of the period that is over
const AxisValues& Exchange::command(double age_s, double share, double since_s) noexcept {
  commanded_ = role_ == Role::kMass ? force_guard_.tick(age_s, sensed_, share, since_s)
                                    : position_guard_.tick(age_s, since_s);
  is_commanded_ = true;
  commanded_answer_ = answers_.in_use();
  driver_.record_age(age_s);
  return commanded_;
}

/// The newest answer is at the motors now.
void Exchange::record_application() noexcept {
  if (!std::exchange(pending_, false)) return;
  const std::int64_t delay_nsec = clock_() - answers_.newest().answered_time_nsec;
  if (!lockstep_) sample_.answer_delay_s = static_cast<double>(delay_nsec) * 1e-9 * age_scale_;
  const bool is_first = std::exchange(unapplied_, false);
  if (is_first && age_scale_ == 1.0) meter_.record_latency(delay_nsec);
}

/// Reads the sensors at the end of a period. @return false when they say nothing
bool Exchange::sense() noexcept {
  const bool sensed = driver_.read(sensed_) && all_finite(sensed_, config_.layout.count);
  if (!sensed) sensed_ = last_sensed_;  // a hand does not jump
  if (role_ == Role::kLiaison && is_commanded_) add_work(last_sensed_);
  last_sensed_ = sensed_;
  return sensed;
}

void Exchange::end_tick(double age_s) noexcept {
  meter_.count_tick();
  const PassivityObserver& observer = force_guard_.energy();
  meter_.record_energy(role_ == Role::kMass ? observer.given_j() : -sample_.work_j,
                       role_ == Role::kMass && observer.is_damping());
  if (!present_) force_guard_.let_go();  // a device that comes back is ramped up again
  if (leaving_age_s_ <= 0.0)
    record_phase(answers_.has_any() && age_s < config_.force_guard.watchdog_s);
}

void Exchange::step() noexcept {
  const double age = age_for_guard();
  written_ = driver_.write(command(age, 0.0, ForceGuard::kWholePeriod));
  record_application();
  const bool sensed = sense();
  present_ = written_ && sensed;
  end_tick(age);
}

/// The driver has lived through the period before; what its sensors say now is sent at once.
void Exchange::begin_period() noexcept {
  sensed_nsec_ = clock_();
  const bool alive = driver_.begin_period();
  const bool sensed = sense();
  present_ = written_ && alive && sensed;
  if (leaving_age_s_ <= 0.0) send_sample();
}

void Exchange::play_period() noexcept {
  const bool leaving = leaving_age_s_ > 0.0;
  if (!leaving) receive();
  if (!driver_.changes_within_period()) {
    step();
    if (!leaving) send_sample();
    return;
  }
  begin_period();
  is_ticked_ = false;
  const double wait_s = kAnswerShare / (config_.layout.rate_hz * time_scale_);
  const std::int64_t until = sensed_nsec_ + static_cast<std::int64_t>(wait_s * 1e9);
  if (unapplied_) apply();  // it came too late for the period before
  if (!leaving) apply_answers_until(until);
  if (!is_ticked_) apply();
  end_tick(ticked_age_s_);
}

void Exchange::use_late_answer(std::int64_t until_nsec) noexcept {
  // A period that is half over leaves too little time to go to a position.
  const bool is_used = driver_.changes_within_period() && role_ == Role::kMass && present_ &&
                       leaving_age_s_ <= 0.0 && meter_.phase() == Phase::kRunning;
  if (is_used) apply_answers_until(until_nsec);
}

/// Hands on each new answer as soon as it comes, until the sample sent last is answered.
void Exchange::apply_answers_until(std::int64_t nsec) noexcept {
  GestureMessage answer;
  while (!is_answered()) {
    const std::int64_t left = std::max<std::int64_t>(nsec - clock_(), 0);
    const bool goes_on = repeats() && left > repeat_nsec_;
    if (channel_.receive(answer, std::chrono::nanoseconds(goes_on ? repeat_nsec_ : left))) {
      if (consider(answer)) apply();
    } else if (goes_on) {
      hold_port();
    } else {
      return;
    }
  }
}

/// The newest answer, or what is left of it, goes through the guard to the motors.
void Exchange::apply() noexcept {
  const double share = share_now();
  const double since_s = since_command_s();
  if (!std::exchange(is_ticked_, true)) {
    ticked_age_s_ = age_for_guard();
    written_ = driver_.change_command(command(ticked_age_s_, share, since_s), share);
  } else {
    ticked_age_s_ = age_s();
    commanded_ = role_ == Role::kMass ? force_guard_.tick_again(ticked_age_s_, share, since_s)
                                      : position_guard_.tick_again(ticked_age_s_, since_s);
    commanded_answer_ = answers_.in_use();
    driver_.record_age(ticked_age_s_);
    written_ = driver_.change_command(commanded_, share) && written_;
  }
  record_application();
}

/// How much of the period is over that began with the newest reading, 0..1.
double Exchange::share_now() const noexcept {
  const auto since_s = static_cast<double>(clock_() - sensed_nsec_) * 1e-9;
  return std::clamp(since_s * config_.layout.rate_hz * time_scale_, 0.0, 1.0);
}

void Exchange::record_phase(bool in_time) noexcept {
  const bool other =
      answers_.answers_another(config_.force_guard.watchdog_s / age_scale_, clock_());
  const double unanswered_s = static_cast<double>(++unanswered_periods_) / config_.layout.rate_hz;
  meter_.record_device(present_ || !driver_.has_motors(), other, is_taken());
  misses_scene_ =
      present_ && answers_.has_any() && !other && unanswered_s > config_.force_guard.watchdog_s;
  if (present_ && in_time) {
    meter_.set_phase(Phase::kRunning);
  } else if (driver_.is_yielding() || (present_ && other)) {
    meter_.set_phase(Phase::kStandby);
  } else if (!present_ || answers_.has_any()) {
    meter_.set_phase(driver_.is_let_go() ? Phase::kDisconnected : Phase::kLost);
  }
}

}  // namespace cordis::device
