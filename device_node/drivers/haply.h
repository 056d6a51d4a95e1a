// device_node/drivers/haply.h -- the Haply 2DIY pantograph on its serial protocol, hAPI.
#pragma once

#include "device_node/drivers/hardware.h"
#include "device_node/drivers/jump_check.h"
#include "device_node/drivers/pantograph.h"

namespace cordis::device {

/// How the board of a pantograph is set up: two motors and two encoders, left one first.
struct HaplySettings {
  Pantograph arms;
  Pantograph::Pair rest_m = {0.0, 0.1};  ///< place of the pen where the axes are 0
  std::uint8_t device_id = 5;
  std::array<int, 2> ports = {2, 1};          ///< 1..4, of motor and encoder
  std::array<int, 2> motor_turns = {1, 0};    ///< 1: counter-clockwise
  std::array<int, 2> encoder_turns = {1, 0};  ///< likewise
  std::array<double, 2> offsets_deg = {241.0, -61.0};
  std::array<double, 2> counts_per_turn = {10752.0, 10752.0};
  double torque_limit_n_m = 0.64;  ///< per motor: near a singular pose no torque gives the force
};

/// Request: type, device id, then bytes and floats (IEEE single, little endian). Type 1 configures
/// the board: mask of motor ports and a direction for each; the same for encoders; no sensors; no
/// pulses; offset and counts per turn of each encoder. Type 2 carries the torques [N m], in the
/// order of the ports, and is answered by the device id and one angle [degrees] per encoder, in the
/// same order. There is no checksum. An answer is refused that is not finite, has more than two
/// turns, or fits no pose of the arms. So is a byte that stands in the place of the device id and
/// is another. A place that no hand reaches in a period is not believed before a second answer says
/// the same.
///
/// Axis 0 is x to the right, axis 1 is y away from the bases.
class Haply final : public Hardware {
 public:
  Haply(std::unique_ptr<Wire> wire, const HardwareSettings& settings, const AxisLayout& layout,
        const HaplySettings& haply);

 protected:
  void begin() noexcept override;
  std::size_t greet(Message& message) noexcept override;
  std::size_t release(Message& message) const noexcept override;
  std::size_t request(const AxisValues& force_n, Message& message) noexcept override;
  Received receive(std::uint8_t byte) noexcept override;
  void fall_silent() noexcept override { length_ = 0; }  // of an answer that lost a byte
  void position(AxisValues& position_m) const noexcept override;

 public:
  BoardWatchdog board_watchdog() const noexcept override { return BoardWatchdog::kNone; }

 private:
  static constexpr std::size_t kAnswer = 9;  // id and two floats
  Received take_angles() noexcept;
  std::array<std::size_t, 2> by_port() const noexcept;  // arms in the order of their ports

  HaplySettings haply_;
  std::array<std::uint8_t, kAnswer> answer_{};
  std::size_t length_ = 0;
  bool configured_ = false;
  JumpCheck jumps_;
  Pantograph::Pose pose_;
};

/// Reads the mapping `haply:` of a device file. Empty when it has errors.
std::unique_ptr<Driver> make_haply(const config::Value& section, const AxisLayout& layout,
                                   config::Problems& problems);

}  // namespace cordis::device
