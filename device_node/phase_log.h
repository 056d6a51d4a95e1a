// device_node/phase_log.h -- logs how a device stands with the scene.
#pragma once

#include <cstdint>
#include <string>

#include "device_node/loop_meter.h"
#include "node/repeated_event.h"

namespace cordis::device {

/// Logs the changes of phase of a device; a phase that comes and goes is a line per 5 s. A device
/// that has never answered is missing after 3 s, for a board may reset when its line is opened. Real
/// time: takes no lock, allocates nothing.
class PhaseLog {
 public:
  /// @param driver     and the address of its device: "kfb1 at 192.168.0.7:5005"
  /// @param silence_s  of the scene after which a device is lost
  PhaseLog(std::string device, std::string driver, double silence_s);

  /// A part begins, in which the device waits at first.
  void start() noexcept { noted_ = Phase::kWaiting; }

  /// Notes the present phase. @param has_device  whether the driver has one. @param now_nsec
  /// CLOCK_MONOTONIC. @param is_taken  another process drives the device, and the driver says so
  /// @return whether the phase has changed
  bool note(Phase phase, bool has_device, std::int64_t now_nsec, bool is_taken = false) noexcept;

  /// Reports what has repeated itself. To be called at least now and then.
  void report(std::int64_t now_nsec) noexcept;

 private:
  void log_loss(bool has_device, std::int64_t now_nsec) noexcept;
  void log_absence(std::int64_t now_nsec) noexcept;
  void log_return(std::int64_t now_nsec) noexcept;

  std::string device_;
  std::string driver_;
  double silence_s_;
  Phase noted_ = Phase::kWaiting;
  std::int64_t lost_since_nsec_ = 0;
  bool had_device_ = false;
  bool is_taken_ = false;      // by another process
  bool awaits_first_ = false;  // the device has not answered yet, and no line says so
  bool has_played_ = false;
  node::RepeatedEvent standby_;
  node::RepeatedEvent let_go_;
  node::RepeatedEvent no_device_;
  node::RepeatedEvent no_scene_;
  node::RepeatedEvent takes_over_;
  node::RepeatedEvent returns_;
};

}  // namespace cordis::device
