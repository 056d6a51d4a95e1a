// device_node/drivers/script.h -- a simulated device that plays the timed values of a file.
#pragma once

#include <memory>
#include <vector>

#include "device_node/drivers/open_loop_driver.h"
#include "device_node/drivers/trajectory.h"
#include "node/config/value.h"

namespace cordis::device {

/// Timed positions (role mass) or forces (role liaison), one path per axis.
class Script final : public OpenLoopDriver {
 public:
  /// @param positions  one per axis [m], or none when the script has no positions
  /// @param forces     one per axis [N], or none when the script has no forces
  Script(std::vector<Trajectory> positions, std::vector<Trajectory> forces, double rate_hz);

  bool can_play(Role role) const noexcept override;
  bool read(AxisValues& sensed) noexcept override;

 private:
  std::vector<Trajectory> positions_;
  std::vector<Trajectory> forces_;
};

/// Reads the mapping `script:` of a device file. Empty when it has errors.
std::unique_ptr<Driver> make_script(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems);

}  // namespace cordis::device
