// sim_node/simulation.h -- one scene in motion, tick by tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim_node/device_exchange.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// A scene, its world and the exchanges with its devices. A tick is one gesture period:
/// steps_per_tick() steps of the world between a sample of the devices and the answer to it. [Luc90
/// V.1 Force feedback gestual transducers] Nothing here knows of DDS, threads or clocks.
class Simulation {
 public:
  /// @param run  of this sim_node
  Simulation(scene::Scene scene, std::uint64_t run);

  /// One gesture period. @param row  room for one value per signal of the scene, taken after the
  /// last step. Real time: as steps_per_tick() steps; allocates nothing, does not throw. Does
  /// nothing once failed().
  void tick(double* row) noexcept;

  /// The exchange of a device, nullptr when no port of the scene is its.
  DeviceExchange* find(std::uint32_t device_id) noexcept;
  std::vector<DeviceExchange>& devices() noexcept { return devices_; }

  const scene::Scene& scene() const noexcept { return scene_; }
  const engine::World& world() const noexcept { return world_; }
  int steps_per_tick() const noexcept { return steps_per_tick_; }
  std::uint64_t tick_count() const noexcept { return tick_count_; }
  double simulated_s() const noexcept;

  /// The scene diverged: a position is no longer finite. Its forces must not be used any more.
  bool failed() const noexcept { return failed_; }
  /// Which MAT left the finite numbers first, and when; empty while nothing failed.
  std::string failure() const;

 private:
  scene::Scene scene_;
  engine::World world_;
  std::vector<DeviceExchange> devices_;
  int steps_per_tick_;
  std::uint64_t tick_count_ = 0;
  bool failed_ = false;
};

}  // namespace cordis::sim
