#include "sim_node/scene/signal.h"

#include <algorithm>
#include <utility>

namespace cordis::scene {

namespace {

using engine::Vec3;

/// Distance of the ends of a link and its growth per second, by the law of engine::Link.
struct Stretch {
  double distance = 0.0;
  double growth = 0.0;
};

Stretch stretch_of(const engine::Link& link, const engine::World& world) noexcept {
  const Vec3 along = world.position(link.mat_b) - world.position(link.mat_a);
  const Vec3 moved = world.velocity(link.mat_b) - world.velocity(link.mat_a);
  if (world.network().dimension() == 1) return {along.x(), moved.x()};
  const double distance = along.norm();
  return {distance, distance > 0.0 ? along.dot(moved) / distance : 0.0};
}

double value_of_link(const Signal& signal, const engine::World& world) noexcept {
  const engine::Link& link = world.network().description().links[signal.index];
  const Stretch stretch = stretch_of(link, world);
  const double elongation = stretch.distance - link.rest_length;
  switch (signal.quantity) {
    case Quantity::kDistance:
      return stretch.distance;
    case Quantity::kElongation:
      return elongation;
    case Quantity::kGrowth:
      return stretch.growth;
    default:
      break;
  }
  const bool without_direction = world.network().dimension() > 1 && stretch.distance == 0.0;
  return without_direction ? 0.0 : link.stiffness * elongation + link.viscosity * stretch.growth;
}

double value_of_scene(Quantity quantity, const engine::Energy& energy) noexcept {
  switch (quantity) {
    case Quantity::kKineticEnergy:
      return energy.kinetic;
    case Quantity::kElasticEnergy:
      return energy.elastic;
    case Quantity::kGravityEnergy:
      return energy.gravity;
    case Quantity::kDissipatedEnergy:
      return energy.dissipated;
    case Quantity::kPortWork:
      return energy.port_work;
    default:
      return energy.total();
  }
}

double value_of(const Signal& signal, const engine::World& world,
                const engine::Energy& energy) noexcept {
  switch (signal.quantity) {
    case Quantity::kPosition:
      return signal.direction.dot(world.position(signal.index)) - signal.offset;
    case Quantity::kVelocity:
      return signal.direction.dot(world.velocity(signal.index));
    case Quantity::kForce:
      return signal.direction.dot(world.link_force(signal.index));
    case Quantity::kSpeed:
      return world.velocity(signal.index).norm();
    case Quantity::kDistance:
    case Quantity::kElongation:
    case Quantity::kGrowth:
    case Quantity::kPull:
      return value_of_link(signal, world);
    default:
      return value_of_scene(signal.quantity, energy);
  }
}

}  // namespace

SignalReader::SignalReader(std::vector<Signal> signals) : signals_(std::move(signals)) {
  wants_energy_ = std::any_of(signals_.begin(), signals_.end(), [](const Signal& signal) {
    return signal.quantity >= Quantity::kEnergy;
  });
}

void SignalReader::read(const engine::World& world, double* values) const noexcept {
  const engine::Energy energy = wants_energy_ ? world.energy() : engine::Energy{};
  for (const Signal& signal : signals_) *values++ = value_of(signal, world, energy);
}

}  // namespace cordis::scene
