// device_node/axis.h -- the axes of a device: keys, or directions of a thimble.
#pragma once

#include <array>
#include <cstdint>

#include "node/config/max_axes.h"

namespace cordis::device {

using config::kMaxAxes;

/// One value per axis: positions [m] or forces [N]. Entries past the device's axes are 0.
using AxisValues = std::array<double, kMaxAxes>;

/// Which half of the mechanical dipole the device plays. A scene decides it.
/// Source: [Luc90 V.1 Force feedback gestual transducers].
enum class Role : std::uint8_t {
  kMass = 0,    ///< gives positions, receives forces
  kLiaison = 1  ///< gives forces, receives positions
};

const char* name_of(Role role) noexcept;  ///< "mass" or "liaison", as a scene spells it

/// What is common to all axes of a device, whoever drives it. SI units.
struct AxisLayout {
  int count = 1;                  ///< 1..16
  double lowest_m = -0.04;        ///< lower end of travel; rest is 0, up is positive
  double highest_m = 0.0;         ///< upper end of travel
  double rate_hz = 1000.0;        ///< samples per second
  bool has_other_player = false;  ///< another node plays the same device (`standby_for`)
  double force_limit_n = 20;      ///< largest force the device gives or measures, either direction
  // What else bounds the forces of a motor that a driver commands by itself, role liaison.
  double slew_n_per_s = 5000.0;
  double power_w = 40.0;
  double start_ramp_s = 0.2;
  double watchdog_s = 0.02;
};

/// The first `count` values are finite numbers.
bool all_finite(const AxisValues& values, int count) noexcept;

}  // namespace cordis::device
