// sim_node/scene/signal.cpp
#include "sim_node/scene/signal.h"

#include <algorithm>
#include <span>
#include <utility>

#include "sim_node/engine/idle_state.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// Distance of the ends of a link and its elongation rate, by the law of engine::Link.
struct Stretch {
  double distance = 0.0;
  double elongation_rate = 0.0;
};

Stretch stretch_of(std::uint32_t a, std::uint32_t b, const engine::World& world) noexcept {
  const Vec3 along = world.position(b) - world.position(a);
  const Vec3 moved = world.velocity(b) - world.velocity(a);
  if (world.network().dimension() == 1) return {along.x(), moved.x()};
  const double distance = along.norm();
  return {distance, distance > 0.0 ? along.dot(moved) / distance : 0.0};
}

double value_of_state_link(const Signal& signal, const engine::World& world) noexcept {
  const engine::StateLink& link = world.network().description().state_links[signal.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  switch (signal.quantity) {
    case Quantity::kDistance:
      return stretch.distance;
    case Quantity::kElongation:
      return stretch.distance - world.rest_length_of(signal.index);
    case Quantity::kElongationRate:
      return stretch.elongation_rate;
    case Quantity::kState:
      return world.state_of(signal.index);
    case Quantity::kRestLength:
      return world.rest_length_of(signal.index);
    default:
      return world.tension_of(signal.index);
  }
}

double value_of_maxwell_link(const Signal& signal, const engine::World& world) noexcept {
  const engine::MaxwellLink& link = world.network().description().maxwell_links[signal.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  return signal.quantity == Quantity::kDistance ? stretch.distance : stretch.elongation_rate;
}

double value_of_link(const Signal& signal, const engine::World& world) noexcept {
  if (signal.kind == LinkKind::kState) return value_of_state_link(signal, world);
  if (signal.kind == LinkKind::kMaxwell) return value_of_maxwell_link(signal, world);
  const engine::Link& link = world.network().description().links[signal.index];
  const Stretch stretch = stretch_of(link.mat_a, link.mat_b, world);
  const double elongation = stretch.distance - link.rest_length;
  switch (signal.quantity) {
    case Quantity::kDistance:
      return stretch.distance;
    case Quantity::kElongation:
      return elongation;
    case Quantity::kElongationRate:
      return stretch.elongation_rate;
    default:
      break;
  }
  const bool without_direction = world.network().dimension() > 1 && stretch.distance == 0.0;
  return without_direction ? 0.0
                           : link.stiffness * elongation + link.viscosity * stretch.elongation_rate;
}

double changes_in(const engine::World& world) noexcept {
  std::uint64_t changes = 0;
  const std::vector<engine::StateMachine>& state_machines =
      world.network().description().state_machines;
  for (std::uint32_t b = 0; b < state_machines.size(); ++b) {
    const auto states = static_cast<std::uint32_t>(state_machines[b].states.size());
    for (std::uint32_t source = 0; source < states; ++source) {
      for (std::uint32_t target = 0; target < states; ++target)
        changes += world.change_count(b, source, target);
    }
  }
  return static_cast<double>(changes);
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
    case Quantity::kSwitchingEnergy:
      return energy.switching;
    default:
      return energy.total();
  }
}

double bonds_in(const engine::World& world, std::size_t set) noexcept {
  double count = 0.0;
  const engine::VisitBoundPair add = [](void* sum, const engine::BoundPair&) {
    *static_cast<double*>(sum) += 1.0;
  };
  world.visit_bound_pairs(set, add, &count);
  return count;
}

double bonds_of(std::span<const std::uint32_t> state_links, const engine::World& world) noexcept {
  const auto holds = [&world](std::uint32_t link) { return !engine::is_idle(world, link); };
  return static_cast<double>(std::ranges::count_if(state_links, holds));
}

/// The MATs that links with states join, each once.
std::vector<std::uint32_t> ends_of(const std::vector<std::uint32_t>& state_links,
                                   const engine::NetworkDescription& network) {
  std::vector<std::uint32_t> ends;
  for (const std::uint32_t link : state_links) {
    ends.push_back(network.state_links[link].mat_a);
    ends.push_back(network.state_links[link].mat_b);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

double value_of_signal(const Signal& signal, const engine::World& world,
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
    case Quantity::kElongationRate:
    case Quantity::kTension:
    case Quantity::kState:
    case Quantity::kRestLength:
      return value_of_link(signal, world);
    case Quantity::kBonds:
      return signal.state_links.empty() ? bonds_in(world, signal.index)
                                        : bonds_of(signal.state_links, world);
    case Quantity::kChanges:
      return changes_in(world);
    default:
      return value_of_scene(signal.quantity, energy);
  }
}

}  // namespace

SignalReader::SignalReader(std::vector<Signal> signals, const engine::NetworkDescription& network)
    : signals_(std::move(signals)), pieces_(signals_.size()) {
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    const Signal& signal = signals_[s];
    if (signal.quantity != Quantity::kPieces) continue;
    if (!signal.state_links.empty()) {
      pieces_[s].emplace(network, ends_of(signal.state_links, network));
    } else if (signal.mats.empty()) {
      pieces_[s].emplace(network, signal.index);
    } else {
      pieces_[s].emplace(network, signal.mats);
    }
    if (signal.near > 0.0) pieces_[s]->keep_near(signal.near);
  }
  mass_count_ = static_cast<double>(network.mass_count());
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    const bool is_energy = signals_[s].quantity >= Quantity::kEnergy;
    wants_energy_ = wants_energy_ || is_energy;
    if (signals_[s].rate != SignalRate::kStep) continue;
    wants_energy_by_step_ = wants_energy_by_step_ || is_energy;
    if (signals_[s].is_sound) sounds_.push_back(by_step_.size());
    by_step_.push_back(s);
  }
}

void SignalReader::read(const engine::World& world, double* values) const noexcept {
  const engine::Energy energy = wants_energy_ ? world.energy() : engine::Energy{};
  for (std::size_t s = 0; s < signals_.size(); ++s) *values++ = value_of(s, world, energy);
}

void SignalReader::read_by_step(const engine::World& world, double* values) const noexcept {
  const engine::Energy energy = wants_energy_by_step_ ? world.energy() : engine::Energy{};
  for (const std::size_t s : by_step_) *values++ = value_of(s, world, energy);
}

double SignalReader::value_of(std::size_t index, const engine::World& world,
                              const engine::Energy& energy) const noexcept {
  const Signal& signal = signals_[index];
  if (signal.quantity == Quantity::kAwake) return 1.0 - world.asleep_count() / mass_count_;
  if (!pieces_[index]) return value_of_signal(signal, world, energy);
  engine::ConnectedComponents& pieces = *pieces_[index];
  std::size_t count = 0;
  if (!signal.state_links.empty()) {
    count = pieces.find_linked(world, signal.state_links);
  } else if (signal.near > 0.0) {
    count = pieces.find_near(world.positions(), signal.near);
  } else {
    count = pieces.find_bound(world, signal.index);
  }
  return static_cast<double>(count);
}

}  // namespace cordis::scene
