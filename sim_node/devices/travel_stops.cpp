// sim_node/devices/travel_stops.cpp
#include "sim_node/devices/travel_stops.h"

#include <algorithm>
#include <utility>

#include "sim_node/checks/port_body.h"

namespace cordis::sim {
namespace {

using engine::Vec3;

/// K' + 4 Z' of both ends of every link of the port, and 5 shares of the stop, stay below 4.
double share_beside(const plan::PortLoad& load, double mass, double dt) {
  constexpr double kMinShare = 0.05;
  const double taken = 2.0 * (load.stiffness * dt + 4.0 * load.viscosity) * dt / mass;
  return std::clamp(0.9 * (4.0 - taken) / 5.0, kMinShare, TravelStops::kShare);
}

}  // namespace

TravelStops::TravelStops(const scene::Scene& scene, const std::vector<scene::Port>& ports)
    : dt_(scene.network.step) {
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  for (const scene::Port& port : ports) {
    const double mass = mass_of(scene, port);
    StoppedPort stopped{port, 0.0, {}};
    stopped.strength =
        share_beside(max_load_of(graph, scene, port), mass, dt_) * mass / (dt_ * dt_);
    for (std::size_t i = 0; i < port.axes.size(); ++i) {
      stopped.axes.push_back({port.axes[i], port.directions[i], {}, {}});
    }
    ports_.push_back(std::move(stopped));
  }
}

void TravelStops::set_reach(const DeviceReach& reach) noexcept {
  const auto put = [](Stop& stop, double wanted) {
    stop.is_new = stop.is_new || wanted != stop.wanted;
    stop.wanted = wanted;
  };
  for (StoppedPort& port : ports_) {
    for (Axis& axis : port.axes) {
      put(axis.upper, reach.highest_m[axis.axis]);
      put(axis.lower, -reach.lowest_m[axis.axis]);
    }
  }
}

/// @param place  of the mass, towards the end [m]  @param way  in a step [m]
/// @param back   by which an end that is beyond its wanted place comes back [m]
/// @return by how far the mass would go beyond the end [m]
double TravelStops::Stop::reaction(double place, double way, double back) noexcept {
  if (std::exchange(is_new, false)) end = std::max(place, wanted);
  end = std::max(wanted, end - back);
  return std::max(place + way - end, 0.0);
}

Vec3 TravelStops::force(std::size_t port, const engine::World& world) noexcept {
  StoppedPort& stopped = ports_[port];
  const Vec3 moved = position_of(world, stopped.port) - stopped.port.rest;
  const Vec3 way = dt_ * velocity_of(world, stopped.port);
  Vec3 force = Vec3::Zero();
  for (Axis& axis : stopped.axes) {
    const double place = moved.dot(axis.direction);
    const double increment = way.dot(axis.direction);
    const double above = axis.upper.reaction(place, increment, kReturn * dt_);
    const double below = axis.lower.reaction(-place, -increment, kReturn * dt_);
    force += stopped.strength * (below - above) * axis.direction;
  }
  return force;
}

}  // namespace cordis::sim
