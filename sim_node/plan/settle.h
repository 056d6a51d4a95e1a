// sim_node/plan/settle.h -- the poses in which a network is at rest.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// What is asked of settling.
struct Settling {
  double until = 0.0;           ///< it ends once no mass is pulled by more [N], or only by rounding
  std::uint64_t max_steps = 0;  ///< it ends after so many of all lengths, settled or not
  bool has_friction = true;     ///< false: contacts slide freely meanwhile
};

/// What came of settling.
struct Settled {
  std::vector<engine::Vec3> position;  ///< position of each MAT [m]
  /// What friction remembers there of the contacts of each set.
  std::vector<std::vector<engine::StartStretch>> stretches;
  double force = 0.0;         ///< the largest on a mass there [N]
  std::uint32_t pulled = 0;   ///< the mass that has it
  bool comes_nearer = false;  ///< half of the steps before, more than twice that pulled
  std::uint64_t steps = 0;    ///< number of computed steps
  std::optional<std::uint32_t> slides_on;  ///< what the pulled mass slides on, if it does
  bool falls = false;                      ///< next to nothing but its load pulls the pulled mass
  bool is_finite = true;                   ///< false: it diverged; the rest says nothing then
  bool is_rounding = false;                ///< what pulls falls no more, and is rounding
};

/// True if the law of a state of the start or a driven force asks for a variable other than the time: then no pose
/// is at rest for the values of the start alone, and settle() takes no such network.
bool rest_is_open(const engine::NetworkDescription& network);

/// Lets a network come to rest from its start, without dampers, medium and velocities. It moves by
/// `cordis` at its step, or a shorter one where that diverges, and at a half and a quarter of it while few steps
/// go by between two holds. It is held still whenever its kinetic
/// energy falls (kinetic damping). Each liaison stays in its state of the start; a
/// Maxwell element keeps its start force. Ports and what is driven stay, and driven forces are those
/// of the start, as are laws of the time; one that depends on the place is that of the place. Friction begins with the stretches of the start, and keeps its own while
/// all is held still. Every vector width finds the same bits.
/// Precondition: !rest_is_open(network).
Settled settle(const engine::NetworkDescription& network, const Settling& asked);

}  // namespace cordis::plan
