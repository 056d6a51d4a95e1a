// sim_node/plan/stability/turning.h -- links that energy may press so short that they turn about.
#pragma once

#include <limits>
#include <optional>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// A spring with a rest length may be pressed by more than a quarter of it in 2 or 3 dimensions. It
/// then turns about so fast that undamped motion may gain energy, though each of its tangents is
/// stable. Likewise any law whose push over the length is above a third of its largest slope. In 1
/// dimension a pair of a set turns about where its ends pass each other, and its push jumps there.
struct Turning {
  /// Pressing the weakest link or pair so far takes this [J]; infinite where none turns.
  double energy = std::numeric_limits<double>::infinity();
  /// A link that the energy of the reach may press so far, the one with the most to spare; none: there
  /// is none.
  std::optional<engine::LiaisonId> liaison;
  double share = 0.0;                        ///< energy of the reach over what that one takes
  std::optional<engine::LiaisonId> weakest;  ///< the one of `share`, whatever that is

  /// Counts with an energy that swings up to this times what it should be.
  void swing(double times) noexcept;
};

/// Where a state of a liaison is followed: inwards, to where its direction turns about.
struct WayInwards {
  double rest_length = 0.0;  ///< [m]
  double farthest = 0.0;     ///< it begins here at most [m]
  double turns_at = 0.0;     ///< [m]; -infinity: it never turns
  bool passes = false;       ///< in 1 dimension: it turns about there alone
};

/// What takes a liaison so far inwards that it turns about [J], from where it stores the least, in its
/// weakest state; infinite where nothing pushes there.
double energy_of_turning(const engine::StateMachine& state_machine, const WayInwards& way,
                         const Reach& reach);

/// Links with states or without, of which one end moves. O(links).
Turning turning_of(const engine::NetworkDescription& network, const Reach& reach);

/// Adds a liaison to those of which the weakest, and the one with the most to spare, are known.
/// @param energy  energy_of_turning()
/// @param reach   of its ends
void add_turning(engine::LiaisonId liaison, double energy, const Reach& reach, Turning& turning);

}  // namespace cordis::plan
