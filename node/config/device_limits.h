// node/config/device_limits.h -- what a device file promises to everyone: its axes and its limits.
#pragma once

#include <array>

#include "node/config/launch.h"
#include "node/config/mapping_reader.h"
#include "node/config/max_axes.h"

namespace cordis::config {

/// The part of a device file that a scene is held against. SI units.
struct DeviceLimits {
  int axis_count = 1;
  int coordinate_count = 1;  ///< the axes, or what an end-effector map makes of them
  /// At least the largest eigenvalue of A A^T, A being the end-effector map: by so much a
  /// coordinate of the handle may be lighter than an axis, and have less viscosity.
  double inertia_ratio = 1.0;
  double rate_hz = 1000.0;
  double lowest_m = -0.04;  ///< workspace of an axis; rest is 0, up is positive
  double highest_m = 0.0;
  double key_pitch_m = 0.0;  ///< width of a key, from which the next one follows; 0: no keyboard
  double force_limit_n = 20.0;
  /// Travel of each coordinate, from stop to stop while the others are free; 0: unknown.
  std::array<double, kMaxAxes> coordinate_travel_m{};
  /// From its rest to its stops, likewise; both 0: unknown.
  std::array<double, kMaxAxes> coordinate_lowest_m{};
  std::array<double, kMaxAxes> coordinate_highest_m{};
  std::array<double, kMaxAxes> coordinate_force_n{};  ///< largest along each alone; 0: unknown
  double moving_mass_kg = 0.05;
  double viscosity_n_s_per_m = 0.0;      ///< 0: unknown
  double stiffness_limit_n_per_m = 0.0;  ///< as declared; 0: what follows from the viscosity
  double damping_limit_n_s_per_m = 0.0;  ///< as declared; 0: likewise
  int delay_periods = 0;                 ///< delay that the device adds on purpose

  /// True if all coordinates have the same travel from their rest.
  bool coordinates_are_alike() const noexcept;

  /// What a hand that moves the handle along any of its coordinates has for certain.
  double coordinate_mass_kg() const noexcept { return moving_mass_kg / inertia_ratio; }
  double coordinate_viscosity_n_s_per_m() const noexcept {
    return viscosity_n_s_per_m / inertia_ratio;
  }
};

/// The mapping of a device_node: the file that its section names (`device: FILE`), with the other
/// keys of the section laid on it. Does not exist after a problem.
Value device_mapping(const Launch& launch, const LaunchNode& node, Problems& problems);

/// Reads these keys, and marks them as known; the reader's owner reads the others.
[[nodiscard]] DeviceLimits read_device_limits(MappingReader& reader);

/// Which device a node plays. When several nodes play one device, the strongest one
/// that runs is received.
struct PlayedDevice {
  std::string name;   ///< `standby_for`: the name of the node itself when it is not given
  int strength = 10;  ///< `strength`: 5 for a node that plays another's device; 1..1000
};

/// Reads these keys, and marks them as known. @param node  name of the node
[[nodiscard]] PlayedDevice read_played_device(MappingReader& reader, const std::string& node);

}  // namespace cordis::config
