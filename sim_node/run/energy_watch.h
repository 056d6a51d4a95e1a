// sim_node/run/energy_watch.h -- the largest energy that a scene has had.
#pragma once

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Sees the energy of a world at some moments, such as its frames, and keeps the largest. A wave with a
/// period near that of the frames may show little of it in each: so a KineticWatch looks between them.
class EnergyWatch {
 public:
  /// Takes what a KineticWatch of the same world has seen [J].
  void add(double largest_kinetic) noexcept;
  /// The energy of the world now; Energy::largest is that over all moments so far. Real time:
  /// O(MATs + links + pairs), no allocation.
  engine::Energy update(const engine::World& world) noexcept;
  /// As update(), and keeps nothing.
  engine::Energy read(const engine::World& world) const noexcept;

 private:
  double largest_ = 0.0;  // [J]
};

}  // namespace cordis::sim
