// device_node/phase_log.cpp
#include "device_node/phase_log.h"

#include <utility>

#include <spdlog/spdlog.h>

namespace cordis::device {
namespace {

constexpr std::int64_t kFirstAnswerWithin = 3'000'000'000;  // [ns]

}  // namespace

PhaseLog::PhaseLog(std::string device, std::string driver, double silence_s)
    : device_(std::move(device)),
      driver_(std::move(driver)),
      silence_s_(silence_s),
      standby_("another process played '" + device_ + "'", spdlog::level::info),
      let_go_("driver " + driver_ + ": the motors were let go of outside the loop"),
      no_device_("driver " + driver_ + ": the device did not answer"),
      no_scene_("no answer from the scene in time, motors at zero"),
      takes_over_("took over '" + device_ + "'", spdlog::level::info),
      returns_("played again", spdlog::level::info) {}

bool PhaseLog::note(Phase phase, bool has_device, std::int64_t now_nsec, bool is_taken) noexcept {
  is_taken_ = is_taken;
  had_device_ = had_device_ || has_device;
  if (phase == noted_) return false;
  const bool was_lost = noted_ == Phase::kLost || noted_ == Phase::kDisconnected;
  if (phase == Phase::kStandby && standby_.record(now_nsec)) {
    spdlog::info("the scene answers another process that plays '{}'; ready to take over", device_);
  } else if (phase == Phase::kDisconnected || phase == Phase::kLost) {
    lost_since_nsec_ = now_nsec;
    if (phase == Phase::kLost) {
      log_loss(has_device, now_nsec);
    } else if (let_go_.record(now_nsec)) {
      spdlog::warn(
          "driver {}: the motors have been let go of outside the loop; forces return by the ramp",
          driver_);
    }
  } else if (phase == Phase::kRunning && noted_ == Phase::kStandby) {
    if (takes_over_.record(now_nsec)) spdlog::info("takes over '{}'", device_);
  } else if (phase == Phase::kRunning && was_lost) {
    log_return(now_nsec);
  }
  has_played_ = has_played_ || phase == Phase::kRunning;
  noted_ = phase;
  return true;
}

void PhaseLog::log_loss(bool has_device, std::int64_t now_nsec) noexcept {
  if (!has_device && !had_device_) {
    awaits_first_ = true;
  } else if (!has_device) {
    log_absence(now_nsec);
  } else if (no_scene_.record(now_nsec)) {
    spdlog::warn("no answer from the scene for more than {} ms: motors at zero", silence_s_ * 1e3);
  }
}

void PhaseLog::log_absence(std::int64_t now_nsec) noexcept {
  if (is_taken_) return;
  if (!no_device_.record(now_nsec)) return;
  spdlog::warn(
      "driver {}: the device does not answer; trying again. Check its power, its cable, and its "
      "address in the device file",
      driver_);
}

void PhaseLog::log_return(std::int64_t now_nsec) noexcept {
  awaits_first_ = false;
  if (!has_played_) {
    spdlog::info("plays '{}'", device_);
    return;
  }
  const double away_s = static_cast<double>(now_nsec - lost_since_nsec_) * 1e-9;
  if (returns_.record(now_nsec, away_s)) spdlog::info("plays again after {:.3f} s", away_s);
}

void PhaseLog::report(std::int64_t now_nsec) noexcept {
  awaits_first_ = awaits_first_ && !had_device_;
  if (awaits_first_ && is_taken_) lost_since_nsec_ = now_nsec;
  if (awaits_first_ && now_nsec - lost_since_nsec_ >= kFirstAnswerWithin) {
    awaits_first_ = false;
    log_absence(now_nsec);
  }
  for (node::RepeatedEvent* event :
       {&standby_, &let_go_, &no_device_, &no_scene_, &takes_over_, &returns_})
    event->report(now_nsec);
}

}  // namespace cordis::device
