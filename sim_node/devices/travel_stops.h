// sim_node/devices/travel_stops.h -- the ends of the travel of a device of role liaison.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_node/devices/device_reach.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// A device of role liaison is carried to where the mass of its port is, and no farther than its
/// travel. Each end of the travel is a wall for the mass: a spring and a damper that only push, with
/// K' = Z' = share of the mass per step,
///
///     f = -(m / dt^2) share (u + dt v - end)   while u + dt v is beyond the end,
///
/// u being the way along the axis. A share of 1 stops the mass in one step. It is at most kShare,
/// and less where links of the port leave less of the limit of the step. A mass that comes with the
/// speed v and is pressed with F rests at F dt^2 / (m share) beyond the end. At kShare it goes
/// beyond by less than v dt / 2 + 2 F dt^2 / (m share). At the least share the first term is up to
/// 4 v dt.
///
/// A mass beyond an end whose place was not known is led back with kReturn.
class TravelStops {
 public:
  static constexpr double kShare = 0.72;  ///< leapfrog, whose limit is K' + 4 Z' < 4, keeps 10 %
  static constexpr double kReturn = 0.2;  ///< [m/s]

  /// @param ports  of the device, role liaison
  TravelStops(const scene::Scene& scene, const std::vector<scene::Port>& ports);

  /// Where the travel ends, as the device describes. Real time: O(1).
  void set_reach(const DeviceReach& reach) noexcept;

  /// Force of the stops on a port in the next step [N]. Once a step for every port. Real time: no
  /// allocation.
  engine::Vec3 force(std::size_t port, const engine::World& world) noexcept;

 private:
  /// One end of the travel along one axis of a port; the lower end looks the other way.
  struct Stop {
    double wanted = DeviceReach::kFarthest;  // [m]
    double end = DeviceReach::kFarthest;     // where it is now [m]
    bool is_new = true;                      // the mass may be beyond it

    double reaction(double place, double way, double back) noexcept;
  };
  struct Axis {
    std::uint32_t axis = 0;  // of the device
    engine::Vec3 direction = engine::Vec3::Zero();
    Stop upper;
    Stop lower;
  };
  struct StoppedPort {
    scene::Port port;
    double strength = 0.0;  // share m / dt^2 [N/m]
    std::vector<Axis> axes;
  };

  std::vector<StoppedPort> ports_;
  double dt_;
};

}  // namespace cordis::sim
