// sim_node/engine/description/world_records.h -- what a world reports, and what it saves.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/state_machine.h"

namespace cordis::engine {

/// What one step has to report. Everything is 0 when nothing is wrong.
struct StepReport {
  std::uint32_t non_finite_mats = 0;  ///< MATs whose new position is not finite
  bool has_energy = true;             ///< false: the works so far are not finite, or above 1e100 J
  std::uint32_t refused_inputs = 0;   ///< positions and forces from outside that were not finite,
                                      ///< since the last step
  std::uint32_t refused_drives = 0;   ///< values of drives that were not finite: their MATs stayed
  std::uint32_t refused_parameters = 0;  ///< formulas of variables in laws that were not finite
  std::uint32_t drive_jumps = 0;         ///< positions of drives that jumped, see jumps()
  std::uint32_t overflowed_sets = 0;     ///< sets with more pairs in range than there was room for:
                                         ///< correct, but slow
  std::uint32_t forgotten_pairs = 0;     ///< pairs of sets whose states found no room
  bool wants_room = false;               ///< World::make_room() is due, before pairs are forgotten
  std::uint32_t lost_events = 0;         ///< changes of state that found no room in events()
};

/// The largest numbers of partners that a mass of a set liaison has at once: of its first set, and
/// of its second, 0 where it has none. Partners exert a force on each other; see touch_distance().
struct PartnerCount {
  std::uint32_t of_p = 0;
  std::uint32_t of_q = 0;
};

/// A pair of a set liaison that is in another state than that of the start.
struct BoundPair {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::uint32_t state = 0;   ///< index of a state in the state machine of the set
  double rest_length = 0.0;  ///< [m]
};

using VisitBoundPair = void (*)(void* owner, const BoundPair& pair);

/// Everything needed to go on later from the same state, bit for bit.
struct Snapshot {
  std::uint64_t network = 0;  ///< Network::fingerprint()
  std::uint64_t step = 0;
  std::vector<double> state;                 ///< opaque
  std::vector<StateMachine> state_machines;  ///< all of them, if one has been replaced; otherwise
                                             ///< none
};

}  // namespace cordis::engine
