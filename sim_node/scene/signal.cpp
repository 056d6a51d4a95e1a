// sim_node/scene/signal.cpp
#include "sim_node/scene/signal.h"

#include <algorithm>
#include <span>
#include <utility>

#include "sim_node/engine/idle_state.h"
#include "sim_node/engine/variables.h"

namespace cordis::scene {

namespace {

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

/// The MATs that links with states and liaisons of sets join, each once.
std::vector<std::uint32_t> ends_of(const Signal& signal,
                                   const engine::NetworkDescription& network) {
  std::vector<std::uint32_t> ends;
  for (const std::uint32_t set : signal.sets) {
    for (const auto* half : {&network.sets[set].set_p, &network.sets[set].set_q})
      ends.insert(ends.end(), half->begin(), half->end());
  }
  for (const std::uint32_t link : signal.state_links) {
    ends.push_back(network.state_links[link].mat_a);
    ends.push_back(network.state_links[link].mat_b);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

}  // namespace

SignalReader::SignalReader(std::vector<Signal> signals, const engine::NetworkDescription& network)
    : signals_(std::move(signals)), pieces_(signals_.size()) {
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    const Signal& signal = signals_[s];
    if (signal.quantity != Quantity::kPieces) continue;
    if (!signal.state_links.empty() || !signal.sets.empty()) {
      pieces_[s].emplace(network, ends_of(signal, network));
    } else if (signal.mats.empty()) {
      pieces_[s].emplace(network, signal.index);
    } else {
      pieces_[s].emplace(network, signal.mats);
    }
    if (signal.near > 0.0) pieces_[s]->keep_near(signal.near);
  }
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    const bool is_energy = engine::is_energy(signals_[s].quantity);
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
  if (signal.quantity == Quantity::kBonds) {
    if (signal.state_links.empty() && signal.sets.empty()) return bonds_in(world, signal.index);
    double count = bonds_of(signal.state_links, world);
    for (const std::uint32_t set : signal.sets) count += bonds_in(world, set);
    return count;
  }
  if (!pieces_[index]) return engine::value_of(signal, world, energy);
  engine::ConnectedComponents& pieces = *pieces_[index];
  std::size_t count = 0;
  if (!signal.state_links.empty() || !signal.sets.empty()) {
    count = pieces.find_joined(world, signal.sets, signal.state_links);
  } else if (signal.near > 0.0) {
    count = pieces.find_near(world.positions(), signal.near);
  } else {
    count = pieces.find_bound(world, signal.index);
  }
  return static_cast<double>(count);
}

}  // namespace cordis::scene
