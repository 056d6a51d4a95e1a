// device_node/drivers/pointer.h -- simulated keys in the hand of somebody who drags them on a page.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "device_node/drivers/driver.h"
#include "device_node/drivers/mock.h"
#include "device_node/drivers/pointer_port.h"
#include "node/time.h"

namespace cordis::device {

/// What holds for the hand of a pointer. SI units.
struct PointerSettings {
  double speed_limit_m_per_s = 1.0;  ///< largest speed of its target, > 0
  double silence_s = kPageSilence;   ///< without a word from the page, after which it lets go, > 0
  double fade_s = 0.15;              ///< over which a hand takes hold and lets go, > 0
  /// The device is away while no page holds it, so that the next strongest node plays it.
  bool only_while_held = false;
};

/// Keys with the mechanics of the driver `mock`, each with a hand that follows the pointer of a
/// page through its own spring. A force holds the key back from the pointer by F/K.
///
/// A target comes every 16 ms or so. The hand follows it with a lag of kLag and no faster than the
/// speed limit, so that no target makes a jump of force. An axis that is not held keeps its hand where
/// it was when the finger is in a ring (`holds`), and is free otherwise. A hand that lets go fades.
/// The hand moves in simulated time. A page is silent after `silence_s` of real time without a word.
class Pointer final : public Driver {
 public:
  static constexpr double kLag = 0.008;  ///< [s]

  using ClockFunction = std::int64_t (*)() noexcept;  ///< CLOCK_MONOTONIC [ns]

  /// @throws std::invalid_argument as Mock does
  Pointer(const MockSettings& mechanics, const PointerSettings& settings, const AxisLayout& layout,
          ClockFunction clock = &node::monotonic_nsec);

  bool can_play(Role) const noexcept override { return true; }
  void start(Role role) noexcept override;
  bool read(AxisValues& sensed) noexcept override;
  bool write(const AxisValues& commanded) noexcept override;
  bool changes_within_period() const noexcept override { return true; }
  bool begin_period() noexcept override;
  bool change_command(const AxisValues& commanded, double share) noexcept override;
  bool is_yielding() const noexcept override { return is_away_; }
  PointerPort* pointer_port() noexcept override { return &port_; }
  void stop() noexcept override {}

 private:
  struct Axis {
    double wanted_m = 0.0;  // by the page
    double target_m = 0.0;  // of the hand
    double grip = 0.0;      // of the hand, 0..1
  };

  void take_target() noexcept;
  void appear() noexcept;
  void move_hands() noexcept;
  double place_within_travel(int axis) const noexcept;
  void record_command(const AxisValues& commanded) noexcept;
  void report() noexcept;

  PointerSettings settings_;
  AxisLayout layout_;
  double period_s_;
  bool is_ring_;
  ClockFunction clock_;
  Mock mock_;
  PointerPort port_;
  PointerTarget newest_;
  std::array<Axis, kMaxAxes> axes_{};
  AxisValues command_{};
  Role role_ = Role::kMass;
  std::int64_t received_nsec_ = 0;  // when the newest target was taken
  bool holds_ = false;
  bool is_away_ = false;
  std::uint64_t period_ = 0;
  std::uint64_t pending_number_ = 0;  // taken, and its force not yet at the motors; 0: none
  std::uint64_t pending_period_ = 0;  // when it was taken
  PointerFeel feel_;
};

/// Reads the mapping `pointer:` of a device file, beneath which the mapping `mock:` lies. Empty when it
/// has errors.
std::unique_ptr<Driver> make_pointer(const config::Value& section, const AxisLayout& layout,
                                     config::Problems& problems);

}  // namespace cordis::device
