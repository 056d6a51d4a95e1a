// device_node/drivers/mock.h -- a keyboard and the hands on it, simulated.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "device_node/drivers/driver.h"
#include "device_node/drivers/mock_settings.h"

namespace cordis::device {

/// Keys with mechanics of their own, each moved by a simulated hand or by the force it is given
/// alone.
///
/// Role mass: the motor pushes the key with the force it is given; the hand feels it.
/// Role liaison: the motor carries the key to the position it is given; the sensor measures the
/// hand's force.
/// In real time a force acts from the moment on at which it is given; a position is reached at the
/// end of the period in which it is given.
/// Depends on what it is given, and when in a period, and on nothing else: same forces, same positions, to the last bit,
/// the noise of its sensors included.
class Mock final : public Driver {
 public:
  /// @throws std::invalid_argument when a setting is out of range, or when its mechanics are too
  ///         fast to be simulated in real time.
  Mock(const MockSettings& settings, const AxisLayout& layout);

  bool can_play(Role role) const noexcept override;
  void start(Role role) noexcept override;
  bool read(AxisValues& sensed) noexcept override;
  bool write(const AxisValues& commanded) noexcept override;
  bool changes_within_period() const noexcept override { return true; }
  bool begin_period() noexcept override;
  bool change_command(const AxisValues& commanded, double share) noexcept override;
  void stop() noexcept override {}  // its motors hold for one period at most

  /// The hand on an axis that has one.
  Hand& hand(int axis) noexcept { return *axes_[static_cast<std::size_t>(axis)].hand; }
  /// Key and hand at rest there.
  void place(int axis, double position_m) noexcept;
  double position_m(int axis) const noexcept {
    return axes_[static_cast<std::size_t>(axis)].key.position_m();
  }
  /// On the key.
  double force_of_hand_n(int axis) const noexcept {
    return force_of_hand(axes_[static_cast<std::size_t>(axis)]);
  }

  int sub_steps() const noexcept { return sub_steps_; }  ///< per period

 private:
  struct Axis {
    MockKey key;
    std::optional<Hand> hand;
    Sensor position_sensor;
    Sensor force_sensor;
    double delay_s = 0.0;
    double from_m = 0.0;  // role liaison: where it is carried from
  };

  double sense(Axis& axis) const noexcept;
  void take_command(const AxisValues& commanded) noexcept;
  void step_until(double sub_step) noexcept;
  void step(Axis& axis, double commanded, double from, double to) noexcept;
  double force_of_hand(const Axis& axis) const noexcept;

  AxisLayout layout_;
  int sub_steps_ = 1;
  double sub_step_s_ = 0.0;
  Role role_ = Role::kMass;
  std::uint64_t period_index_ = 0;  // periods since start()
  bool is_in_period_ = false;       // in real time
  double lived_ = 0.0;              // of the present period [sub-steps]
  double commanded_at_ = 0.0;       // when the command came [sub-steps]
  AxisValues command_{};
  std::vector<Axis> axes_;
};

/// Reads the mapping `mock:` of a device file. Every key has a default; without `hand:` no
/// hand touches the keys. Empty when the mapping has errors.
std::unique_ptr<Driver> make_mock(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems);

}  // namespace cordis::device
