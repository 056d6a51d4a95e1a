// sim_node/engine/links/link_event.h -- one change of state of one link.
#pragma once

#include <cstdint>
#include <limits>

#include "sim_node/engine/expressions/program.h"

namespace cordis::engine {

/// LinkEvent::link of a pair of a set liaison.
inline constexpr std::uint32_t kNoLink = std::numeric_limits<std::uint32_t>::max();

struct LinkEvent {
  std::uint64_t step = 0;  ///< in which it happened: the step that began at World::step_count() =
                           ///< step
  std::uint32_t link = kNoLink;  ///< index in state_links
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::uint32_t state_machine = 0;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  Quantity quantity = Quantity::kNone;  ///< what triggered: Transition::triggered, kNone when it
                                        ///< was forced
  double value = 0.0;                   ///< its value, in its own SI unit
  double energy = 0.0;  ///< stored in the link after minus before the change [J]: what it added
};

}  // namespace cordis::engine
