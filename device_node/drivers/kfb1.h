// device_node/drivers/kfb1.h -- keyboards that people build themselves: docs/kfb1.md.
#pragma once

#include <array>

#include "device_node/drivers/hardware.h"
#include "node/repeated_event.h"

namespace cordis::device {

/// KFB1: COBS frames with a checksum; each FORCE is answered by one STATE with its number. The
/// driver asks what the device is, and refuses one with another number of keys. The log says where
/// its travel or its force is not that of the device file. The driver then sends the rate and the
/// largest force of the device file. It does so again after a restart of the board, which its time
/// shows. EVENTs are logged; at an emergency stop, an overheated motor or its watchdog the board
/// has let go.
class Kfb1 final : public Hardware {
 public:
  using Hardware::Hardware;

 protected:
  void begin() noexcept override;
  std::size_t greet(Message& message) noexcept override;
  std::size_t configure(Message& message) noexcept override;
  std::size_t release(Message& message) const noexcept override;
  std::size_t request(const AxisValues& force_n, Message& message) noexcept override;
  Received receive(std::uint8_t byte) noexcept override;
  void report_repeats(std::int64_t now_nsec) noexcept override;
  void position(AxisValues& position_m) const noexcept override { position_m = newest_; }

 public:
  BoardWatchdog board_watchdog() const noexcept override { return BoardWatchdog::kLetsGo; }

 private:
  Received take_frame() noexcept;
  Received take_info(std::span<const std::uint8_t> payload) noexcept;
  Received take_state(std::span<const std::uint8_t> payload) noexcept;
  Received take_event(std::uint8_t code) noexcept;
  bool has_restarted(std::uint32_t board_usec) noexcept;
  void compare_with_file() noexcept;

  Message frame_{};  // bytes since the last 0
  std::size_t length_ = 0;
  std::uint8_t sequence_ = 0;          // of the newest FORCE
  double travel_m_ = 0.04;             // as the device says
  double force_n_ = 20.0;              // likewise: of the largest value
  std::uint8_t logged_ = 0;            // code of the EVENT that was logged last, while it goes on
  std::int64_t event_nsec_ = 0;        // when it came last
  std::int64_t asked_nsec_ = 0;        // when the newest FORCE was sent
  std::uint32_t board_usec_ = 0;       // time of the board in a STATE
  std::int64_t board_asked_nsec_ = 0;  // when that STATE was asked for at the latest; 0: none
  AxisValues newest_{};                // [m]
  std::array<node::RepeatedEvent, 5> events_{
      // by the code of the EVENT
      node::RepeatedEvent("kfb1: an event without a name"),
      node::RepeatedEvent("kfb1: the board reports again: it is too hot"),
      node::RepeatedEvent("kfb1: the board reports again: emergency stop"),
      node::RepeatedEvent("kfb1: the board reports again: a motor is saturated"),
      node::RepeatedEvent("kfb1: the board reports again: its watchdog has fired")};
  node::RepeatedEvent restarts_{"kfb1: the board has restarted again"};
  node::RepeatedEvent wrong_boards_{"kfb1: the device is still not that of the device file",
                                    spdlog::level::err};
  node::RepeatedEvent comparisons_{"kfb1: the device was greeted again, and differs from its file"};
};

/// Reads the mapping `kfb1:` of a device file. Empty when it has errors.
std::unique_ptr<Driver> make_kfb1(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems);

}  // namespace cordis::device
