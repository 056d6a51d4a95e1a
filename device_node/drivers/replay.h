// device_node/drivers/replay.h -- a device that plays the hand of a take, whatever it is answered.
#pragma once

#include <memory>
#include <vector>

#include "device_node/drivers/driver.h"
#include "node/config/value.h"

namespace cordis::device {

/// What a device of a take gave, period by period.
struct RecordedHand {
  double rate_hz = 1000.0;         ///< of its samples
  std::vector<AxisValues> values;  ///< one per period: positions [m], or forces [N]
  bool is_empty() const noexcept { return values.empty(); }
};

/// The positions (role mass) or forces (role liaison) of a take, at the time that each has in it;
/// joined by straight lines where rates differ. After the end positions stay, and forces are 0.
class Replay final : public Driver {
 public:
  /// @param positions  of role mass, may be empty
  /// @param forces     of role liaison, may be empty
  /// @param rate_hz    of this device
  /// @param from_s     of the take, where it begins [s]
  Replay(RecordedHand positions, RecordedHand forces, double rate_hz, double from_s, bool repeats);

  bool can_play(Role role) const noexcept override;
  void start(Role role) noexcept override;
  bool read(AxisValues& sensed) noexcept override;
  bool write(const AxisValues& commanded) noexcept override;
  bool changes_within_period() const noexcept override { return true; }
  bool begin_period() noexcept override;
  bool change_command(const AxisValues&, double) noexcept override { return true; }
  void stop() noexcept override {}  // it has no motor

 private:
  RecordedHand positions_;
  RecordedHand forces_;
  double rate_hz_;
  double from_s_;
  bool repeats_;
  Role role_ = Role::kMass;
  std::uint64_t period_index_ = 0;  // periods lived since start()
  bool is_in_period_ = false;       // in real time
};

/// Reads the mapping `replay:` of a device file, and the take that it names. Empty when there are
/// errors.
std::unique_ptr<Driver> make_replay(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems);

}  // namespace cordis::device
