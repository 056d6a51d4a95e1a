// device_node/drivers/mock.h -- a keyboard and the hands on it, simulated.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "device_node/drivers/driver.h"
#include "device_node/drivers/hand.h"
#include "device_node/drivers/mock_key.h"
#include "device_node/drivers/sensor.h"
#include "node/config/value.h"

namespace cordis::device {

/// What a simulated keyboard is made of.
struct MockSettings {
  KeySettings key;    ///< of every key; its ends of travel are those of the layout
  HandSettings hand;  ///< of every hand
  std::vector<Trajectory> gesture = {Trajectory()};  ///< target of the hands: one, or one each
  std::vector<int> played;                           ///< axes that have a hand on them
  double stagger_s = 0.0;          ///< each hand begins so much later than the one before
  SensorSettings position_sensor;  ///< [m]
  SensorSettings force_sensor;     ///< [N]
  std::uint64_t seed = 1;          ///< of their noise
};

/// Keys with mechanics of their own, each moved by a simulated hand or by the force it is given
/// alone.
///
/// Role mass: the motor pushes the key with the force it is given; the hand feels it.
/// Role liaison: the motor carries the key to the position it is given; the sensor measures the
/// hand's force.
/// Depends on what it is given and on nothing else: same forces, same positions, to the last bit,
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
  void stop() noexcept override {}  // its motors hold for one period at most

  int sub_steps() const noexcept { return sub_steps_; }  ///< per period

 private:
  struct Axis {
    MockKey key;
    std::optional<Hand> hand;
    Sensor position_sensor;
    Sensor force_sensor;
    double delay_s = 0.0;
  };

  double sense(Axis& axis) const noexcept;
  void live(Axis& axis, double commanded) noexcept;
  double force_of_hand(const Axis& axis) const noexcept;

  AxisLayout layout_;
  int sub_steps_ = 1;
  double sub_step_s_ = 0.0;
  Role role_ = Role::kMass;
  std::uint64_t period_index_ = 0;  // periods lived since start()
  std::vector<Axis> axes_;
};

/// Reads the mapping `mock:` of a device file. Every key has a default; without `hand:` nobody
/// touches the keys. Empty when the mapping has errors.
std::unique_ptr<Driver> make_mock(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems);

}  // namespace cordis::device
