// sim_node/devices/device_exchange.cpp
#include "sim_node/devices/device_exchange.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "node/assert.h"
#include "node/hand_speed.h"
#include "sim_node/checks/port_body.h"

namespace cordis::sim {

DeviceExchange::DeviceExchange(std::string device, std::uint32_t device_id, Role role,
                               std::vector<scene::Port> ports, double rate_hz, std::uint64_t epoch)
    : device_(std::move(device)),
      device_id_(device_id),
      role_(role),
      ports_(std::move(ports)),
      epoch_(epoch),
      patience_ticks_(std::max(3, static_cast<int>(std::lround(kDisconnectedAfter * rate_hz)))),
      sequence_(rate_hz, patience_ticks_),
      rejoin_ticks_(std::max(1, static_cast<int>(std::lround(kRejoin * rate_hz)))),
      rate_hz_(rate_hz),
      silent_ticks_(patience_ticks_ + 1),
      unheard_ticks_(patience_ticks_ + 1),
      described_ticks_(std::max(3, static_cast<int>(std::lround(kDescribed * rate_hz)))),
      undescribed_ticks_(described_ticks_) {
  for (const scene::Port& port : ports_) {
    for (const std::uint32_t axis : port.axes) axis_count_ = std::max(axis_count_, axis + 1);
  }
}

void DeviceExchange::take_over(const DeviceExchange& before, bool at_once) noexcept {
  sequence_.continue_from(before.sequence_);
  answers_ = before.answers_;
  refused_count_ = before.refused_count_;
  if (before.is_described())
    undescribed_ticks_ = std::min(before.undescribed_ticks_, described_ticks_);
  if (role_ != before.role_) return;
  newest_ = before.newest_;
  has_new_ = before.has_new_;
  restarted_ = before.restarted_;
  is_supported_ = before.is_supported_;
  refused_ticks_ = before.refused_ticks_;
  restart_left_ = before.restart_left_;
  if (!at_once) return;
  from_ = before.from_;
  to_ = before.to_;
  silent_ticks_ = before.silent_ticks_;
  is_expected_ = before.is_expected_;
  rejoin_left_ = before.rejoin_left_;
  even_ticks_ = before.even_ticks_;
}

void DeviceExchange::let_go() noexcept {
  has_new_ = false;
  is_expected_ = false;
  silent_ticks_ = patience_ticks_ + 1;
}

double DeviceExchange::force_share() const noexcept {
  if (is_disconnected()) return 0.0;
  return 1.0 - static_cast<double>(rejoin_left_) / static_cast<double>(rejoin_ticks_);
}

template <class Sample, class Values>
DeviceExchange::Reception DeviceExchange::receive(
    const Sample& sample, const Values& values, bool is_supported,
    const std::array<double, kMaxAxes>& most) noexcept {
  const auto count = static_cast<std::size_t>(sample.axis_count());
  bool usable = sample.epoch() != 0 && count >= axis_count_ && count <= kMaxAxes;
  for (std::size_t axis = 0; usable && axis < count; ++axis) usable = std::isfinite(values[axis]);
  SampleSequence::Position position{.order = SampleSequence::Order::kOlder};
  if (usable) position = sequence_.receive(sample.epoch(), sample.sample(), sample.time_nsec());
  if (position.order == SampleSequence::Order::kRepeated) return Reception::kRepeated;
  if (position.order == SampleSequence::Order::kOlder) {
    ++refused_count_;
    return Reception::kRefused;
  }
  restarted_ = restarted_ || position.restarts;
  after_gap_ = after_gap_ || position.after_gap;
  is_supported_ = is_supported;
  for (std::size_t axis = 0; axis < count; ++axis)
    newest_[axis] = std::clamp(values[axis], -most[axis], most[axis]);
  has_new_ = true;
  ++new_count_;
  return Reception::kNew;
}

DeviceExchange::Reception DeviceExchange::receive(const msg::GesturePositions& sample,
                                                  bool is_supported,
                                                  const DeviceReach& reach) noexcept {
  CORDIS_ASSERT(role_ == Role::kMass);
  return receive(sample, sample.position_m(), is_supported, reach.travel_m);
}

DeviceExchange::Reception DeviceExchange::receive(const msg::GestureForces& sample,
                                                  bool is_supported,
                                                  const DeviceReach& reach) noexcept {
  CORDIS_ASSERT(role_ == Role::kLiaison);
  const std::uint64_t lost_before = lost_sample_count();
  const Reception reception = receive(sample, sample.force_n(), is_supported, reach.force_n);
  if (reception != Reception::kNew) return reception;
  if (travel_stops_) travel_stops_->set_reach(reach);
  take_work(sample, reach, lost_sample_count() - lost_before + 1);
  return reception;
}

/// No hand gives more than its largest force along the way of the fastest one; when a sample reports
/// so, the account of the passivity controller restarts. @param periods  since the sample before
void DeviceExchange::take_work(const msg::GestureForces& sample, const DeviceReach& reach,
                               std::uint64_t periods) noexcept {
  double max_n = 0.0;
  for (std::size_t axis = 0; axis < axis_count_; ++axis) max_n += reach.force_n[axis];
  const double max_j = max_n * kFastestHand * static_cast<double>(periods) / rate_hz_;
  const double given_j = sample.work_j() - hand_work_;
  new_work_ = new_work_ || !(std::abs(given_j) <= max_j);  // also what is no number
  echoed_answer_ = sample.answered_epoch() == epoch_ ? sample.answered_sample() : 0;
  hand_work_ = sample.work_j();
}

void DeviceExchange::begin_tick() noexcept {
  from_ = to_;
  const bool gap = std::exchange(after_gap_, false);
  const bool stood_still = gap && even_ticks_ == rejoin_ticks_;
  even_ticks_ = gap ? 0 : std::min(even_ticks_ + 1, rejoin_ticks_);
  restart_left_ = std::max(restart_left_ - 1, 0);
  undescribed_ticks_ = std::min(undescribed_ticks_ + 1, described_ticks_);
  const int restart_ticks = std::max(8, static_cast<int>(std::lround(kRestart * rate_hz_)));
  if (has_new_ && !is_supported_) {
    refused_ticks_ = std::min(refused_ticks_ + 1, restart_ticks + 1);
  } else if (has_new_ && std::exchange(refused_ticks_, 0) > restart_ticks) {
    restart_left_ = restart_ticks;
  }
  unheard_ticks_ = has_new_ ? 0 : std::min(unheard_ticks_, patience_ticks_) + 1;
  if (!is_supported_) {
    is_expected_ = false;
    silent_ticks_ = patience_ticks_ + 1;
  } else if (has_new_) {
    if (is_disconnected() || restarted_ || stood_still) {
      rejoin_left_ = rejoin_ticks_;
      if (passivity_controller_) passivity_controller_->start();
    }
    restarted_ = false;
    is_expected_ = true;
    silent_ticks_ = 0;
  } else if (!is_disconnected()) {
    ++silent_ticks_;
  }
  has_new_ = false;

  if (is_disconnected()) {
    // Positions are held where they are; the force of a hand that is gone is none.
    if (role_ == Role::kLiaison) to_.fill(0.0);
    if (passivity_controller_) passivity_controller_->start();
    return;
  }
  const double share = 1.0 / static_cast<double>(std::max(rejoin_left_, 1));
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis)
    to_[axis] += share * (newest_[axis] - to_[axis]);
  if (rejoin_left_ <= 1) to_ = newest_;  // exactly, without rounding
  rejoin_left_ = std::max(rejoin_left_ - 1, 0);
}

void DeviceExchange::play(engine::World& world, int number, double share) noexcept {
  CORDIS_ASSERT(number >= 1 && share > 0.0 && share <= 1.0);
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const scene::Port& port = ports_[p];
    engine::Vec3 value = role_ == Role::kMass ? port.rest : engine::Vec3(engine::Vec3::Zero());
    for (std::size_t i = 0; i < port.axes.size(); ++i) {
      const std::size_t axis = port.axes[i];
      // A force is held over the period; a position is ramped.
      const double now = role_ == Role::kMass && share < 1.0
                             ? from_[axis] + share * (to_[axis] - from_[axis])
                             : to_[axis];
      value += now * port.directions[i];
    }
    if (role_ == Role::kMass) {
      world.impose_position(port.mat, value);
      continue;
    }
    engine::Vec3 added = engine::Vec3::Zero();
    if (passivity_controller_) added = passivity_controller_->damping_force(p, world, value);
    if (travel_stops_) {
      // A stop takes more than the damper, and both together might be too much for the step.
      const engine::Vec3 stop = travel_stops_->force(p, world);
      if (!stop.isZero(0.0)) added = stop;
    }
    apply_force(world, port, value + added);
  }
  if (!passivity_controller_ || number != 1) return;
  if (std::exchange(new_work_, false)) passivity_controller_->start();
  passivity_controller_->receive(hand_work_, echoed_answer_, world.dissipated());
}

template <class Answer>
void DeviceExchange::fill_header(Answer& answer, std::int64_t now_nsec) noexcept {
  answer.device_id(device_id_);
  answer.epoch(epoch_);
  answer.sample(++answers_);
  answer.answered_epoch(sequence_.epoch());
  answer.answered_sample(sequence_.number());
  answer.answered_time_nsec(sequence_.time_nsec());
  answer.time_nsec(now_nsec);
  answer.axis_count(axis_count_);
}

msg::GestureForces& DeviceExchange::answer_forces(const engine::World& world, bool safe,
                                                  std::int64_t now_nsec) noexcept {
  fill_header(forces_, now_nsec);
  forces_.force_n().fill(0.0);
  const double share = force_share();
  if (!safe || share == 0.0) return forces_;
  for (const scene::Port& port : ports_) {
    const engine::Vec3 force = world.link_force(port.mat);
    for (std::size_t i = 0; i < port.axes.size(); ++i) {
      forces_.force_n()[port.axes[i]] = share * force.dot(port.directions[i]);
    }
  }
  return forces_;
}

msg::GesturePositions& DeviceExchange::answer_positions(const engine::World& world, bool safe,
                                                        std::int64_t now_nsec) noexcept {
  fill_header(positions_, now_nsec);
  if (passivity_controller_) passivity_controller_->record_answer(answers_);
  if (!safe) return positions_;
  for (const scene::Port& port : ports_) {
    const engine::Vec3 moved = position_of(world, port) - port.rest;
    for (std::size_t i = 0; i < port.axes.size(); ++i) {
      positions_.position_m()[port.axes[i]] = moved.dot(port.directions[i]);
    }
  }
  return positions_;
}

}  // namespace cordis::sim
