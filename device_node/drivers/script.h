// device_node/drivers/script.h -- a device that plays what a file says, whatever it is answered.
#pragma once

#include <memory>
#include <vector>

#include "device_node/drivers/driver.h"
#include "device_node/drivers/trajectory.h"
#include "node/config/value.h"

namespace cordis::device {

/// Timed positions (role mass) or forces (role liaison), one path per axis. What it is answered
/// does not matter to it, so a run is exactly repeatable: sample n is the path at n/rate seconds.
class Script final : public Driver {
 public:
  /// @param positions  one per axis [m], or none when the script has no positions
  /// @param forces     one per axis [N], or none when the script has no forces
  Script(std::vector<Trajectory> positions, std::vector<Trajectory> forces, double rate_hz);

  bool can_play(Role role) const noexcept override;
  void start(Role role) noexcept override;
  bool read(AxisValues& sensed) noexcept override;
  bool write(const AxisValues& commanded) noexcept override;
  bool changes_within_period() const noexcept override { return true; }
  bool begin_period() noexcept override;
  bool change_command(const AxisValues&, double) noexcept override { return true; }
  void stop() noexcept override {}  // it has no motor

 private:
  std::vector<Trajectory> positions_;
  std::vector<Trajectory> forces_;
  double rate_hz_;
  Role role_ = Role::kMass;
  std::uint64_t period_index_ = 0;  // periods lived since start()
  bool is_in_period_ = false;       // in real time
};

/// Reads the mapping `script:` of a device file. Empty when it has errors.
std::unique_ptr<Driver> make_script(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems);

}  // namespace cordis::device
