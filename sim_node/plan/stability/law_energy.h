// sim_node/plan/stability/law_energy.h -- what a law brings into the motion.
#pragma once

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// Where a liaison may be: its state acts at distances from `lowest` to `highest`, both of any sign.
struct Span {
  double from;     ///< it starts at a distance from here [m]
  double to;       ///< up to here
  double lowest;   ///< [m]; -infinity: without an end
  double highest;  ///< [m]; infinity likewise
};

/// What a state pulls at a distance at rest, within its limits, as weakly or as strongly as any masses of the
/// reach have it [N].
Interval tension_at(const engine::LinkState& state, double distance, double rest_length,
                    const Reach& reach);

/// The most that the potential of a state falls from where it starts [J], as it pulls and pushes at
/// rest; infinite where it falls without an end. O(1), about 1000 tensions.
/// @param rest_length  [m]
double fall_of(const engine::LinkState& state, double rest_length, const Span& span,
               const Reach& reach);

/// What a link with states brings in from its start [J], in the state of the start.
double brought_by(const engine::NetworkDescription& network, const engine::StateLink& link);

/// What a set begins with.
struct NearestPairs {
  double nearest = 0.0;  ///< distance of a pair at the start [m]; the range where none is nearer
  double rest_length = 0.0;       ///< the least [m]
  bool all_begin_within = false;  ///< every pair is within range: none comes in from beyond it
};

/// What one pair of a set brings in [J], from its start or from the range on, in the state of the start.
double brought_by_pair(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                       const NearestPairs& start, const Reach& reach);

/// What all pairs of a set bring in likewise, each of its members in one pair [J]; 0 where that has no end.
double brought_by_pairs(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                        const NearestPairs& start, const Reach& reach);

/// True if a state drives its ends apart with a force that grows with the distance.
bool drives_apart(const engine::LinkState& state, double rest_length, bool turns,
                  const Reach& reach);

/// True if its tension over the speed does work on the motion somewhere: it pushes what parts or pulls
/// what meets, less what it does at rest.
/// @param distance  where it may be [m]
/// @param speed     up to which, either way [m/s]
bool drives_motion(const engine::LinkState& state, const Interval& distance, double rest_length,
                   double speed, const Reach& reach);

}  // namespace cordis::plan
