// device_node/drivers/firefader.h -- the FireFader: motor faders with open firmware.
#pragma once

#include "device_node/drivers/hardware.h"
#include "device_node/drivers/jump_check.h"

namespace cordis::device {

/// One or two motor faders. Request: 127, force A, force B (int8, never 127). Answer: 255, position
/// A and B, analog A and B, touch A and B (0..254). There is no checksum and there are no numbers.
/// A byte lost shows as a 255 in the wrong place. A place that no hand reaches in a period is not
/// believed before a second answer says the same. 57600 baud carry about 500 cycles per second.
/// Source: E. Berdahl, A. Kontogeorgakopoulos, FireFader firmware.
class FireFader final : public Hardware {
 public:
  /// @param full_scale_n  force of a fader at the largest value it can be sent
  FireFader(std::unique_ptr<Wire> wire, const HardwareSettings& settings, const AxisLayout& layout,
            double full_scale_n);

 protected:
  void begin() noexcept override;
  std::size_t greet(Message&) noexcept override { return 0; }
  std::size_t release(Message& message) const noexcept override;
  std::size_t request(const AxisValues& force_n, Message& message) noexcept override;
  Received receive(std::uint8_t byte) noexcept override;
  void position(AxisValues& position_m) const noexcept override { position_m = newest_; }

 public:
  BoardWatchdog board_watchdog() const noexcept override { return BoardWatchdog::kUnknown; }

 private:
  static constexpr std::size_t kAnswer = 6;  // bytes after the 255

  double full_scale_n_;
  std::array<std::uint8_t, kAnswer> answer_{};
  std::size_t length_ = kAnswer + 1;  // of the answer so far; more: waits for a 255
  JumpCheck jumps_;
  AxisValues newest_{};  // [m]
};

/// Reads the mapping `firefader:` of a device file. Empty when it has errors.
std::unique_ptr<Driver> make_firefader(const config::Value& section, const AxisLayout& layout,
                                       config::Problems& problems);

}  // namespace cordis::device
