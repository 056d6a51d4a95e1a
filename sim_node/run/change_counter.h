// sim_node/run/change_counter.h -- how often the links of each liaison changed their state.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Sums the changes of state of a world by liaison: state machines of the same name, which differ in
/// their parameters, count together. Past kMaxLiaisons the others count together as the last one.
class ChangeCounter {
 public:
  static constexpr std::size_t kMaxLiaisons = 64;
  using Counts = std::array<std::uint64_t, kMaxLiaisons>;

  explicit ChangeCounter(const std::vector<engine::StateMachine>& state_machines);

  /// Names of the liaisons with states, in the order of the counts.
  const std::vector<std::string>& names() const noexcept { return names_; }

  /// Since the scene began; those past names() are 0. Real time: O(state machines), no allocation.
  Counts count(const engine::World& world) const noexcept;

 private:
  struct Counted {
    std::uint32_t state_machine;
    std::uint32_t state_count;
    std::size_t place;  // in the counts
  };

  std::vector<std::string> names_;
  std::vector<Counted> counted_;
};

}  // namespace cordis::sim
