// sim_node/run/change_counter.cpp
#include "sim_node/run/change_counter.h"

#include <algorithm>

namespace cordis::sim {

ChangeCounter::ChangeCounter(const std::vector<engine::StateMachine>& state_machines) {
  for (std::size_t b = 0; b < state_machines.size(); ++b) {
    if (state_machines[b].exits.empty()) continue;
    auto found = std::ranges::find(names_, state_machines[b].name);
    if (found == names_.end() && names_.size() == kMaxLiaisons) {
      names_.back() = "others";
      found = names_.end() - 1;
    } else if (found == names_.end()) {
      found = names_.insert(names_.end(), state_machines[b].name);
    }
    counted_.push_back({static_cast<std::uint32_t>(b),
                        static_cast<std::uint32_t>(state_machines[b].states.size()),
                        static_cast<std::size_t>(found - names_.begin())});
  }
}

ChangeCounter::Counts ChangeCounter::count(const engine::World& world) const noexcept {
  Counts counts{};
  for (const Counted& counted : counted_) {
    for (std::uint32_t source = 0; source < counted.state_count; ++source) {
      for (std::uint32_t target = 0; target < counted.state_count; ++target)
        counts[counted.place] += world.change_count(counted.state_machine, source, target);
    }
  }
  return counts;
}

}  // namespace cordis::sim
