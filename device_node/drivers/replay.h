// device_node/drivers/replay.h -- a simulated device that plays the recorded hand of a take.
#pragma once

#include <memory>
#include <vector>

#include "device_node/drivers/open_loop_driver.h"
#include "node/config/value.h"

namespace cordis::device {

/// What a device of a take gave, period by period.
struct RecordedHand {
  double rate_hz = 1000.0;         ///< rate of its samples
  std::vector<AxisValues> values;  ///< one per period: positions [m], or forces [N]
  bool is_empty() const noexcept { return values.empty(); }
};

/// The positions (role mass) or forces (role liaison) of a take, at the time that each has in it;
/// joined by straight lines where rates differ. After the end positions stay, and forces are 0.
class Replay final : public OpenLoopDriver {
 public:
  /// @param positions  of role mass, may be empty
  /// @param forces     of role liaison, may be empty
  /// @param rate_hz    of this device
  /// @param from_s     of the take, where it begins [s]
  Replay(RecordedHand positions, RecordedHand forces, double rate_hz, double from_s, bool repeats);

  bool can_play(Role role) const noexcept override;
  bool read(AxisValues& sensed) noexcept override;

 private:
  RecordedHand positions_;
  RecordedHand forces_;
  double from_s_;
  bool repeats_;
};

/// Reads the mapping `replay:` of a device file, and the take that it names. Empty when there are
/// errors.
std::unique_ptr<Driver> make_replay(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems);

}  // namespace cordis::device
