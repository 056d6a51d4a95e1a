// sim_node/run/energy_watch.h -- the largest energy that a scene has had.
#pragma once

#include <cstdint>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Sees the energy of a world at some moments, such as its frames, and keeps the largest. A wave with a
/// period near that of the frames may show little of it in each: so a KineticWatch looks between them.
class EnergyWatch {
 public:
  /// Takes what a KineticWatch of the same world has seen [J].
  void add(double largest_kinetic) noexcept;
  /// The energy of the world now. Energy::largest is the largest of all moments so far. Energy::made_there is
  /// the integration error that viscosity has not dissipated since. Real time: O(MATs + links + pairs), no
  /// allocation.
  engine::Energy update(const engine::World& world) noexcept;
  /// As update(), and keeps nothing.
  engine::Energy read(const engine::World& world) const noexcept;

 private:
  void update_made(const engine::Energy& energy, std::uint64_t step) noexcept;

  double largest_ = 0.0;     // [J]
  double made_ = 0.0;        // [J]
  double error_ = 0.0;       // at the last update() [J]
  double dissipated_ = 0.0;  // likewise [J]
  std::uint64_t step_ = 0;   // likewise
};

}  // namespace cordis::sim
