// sim_node/checks/pair_watch.cpp
#include "sim_node/checks/pair_watch.h"

#include <cstddef>

namespace cordis::sim {

PairWatch::PairWatch(const engine::NetworkDescription& network)
    : limits_(plan::stable_pairs(network)) {
  constexpr std::size_t kMembers = 64;
  for (const plan::PairLimit& limit : limits_) {
    const engine::SetLiaison& set = network.sets[limit.set];
    stride_.push_back(1 + (set.set_p.size() + set.set_q.size()) / kMembers);
  }
}

void PairWatch::update(const engine::World& world) noexcept {
  for (std::size_t k = 0; k < limits_.size(); ++k) {
    if (world.step_count() % stride_[k] != 0) continue;
    const engine::SetLiaison& set = world.network().description().sets[limits_[k].set];
    passed_ = passed_ || !(plan::pair_energy(world, set) <= limits_[k].energy);
  }
}

}  // namespace cordis::sim
