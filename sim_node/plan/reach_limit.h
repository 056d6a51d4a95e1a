// sim_node/plan/reach_limit.h -- the energy and speed up to which a step is certified.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/world.h"

namespace cordis::plan {

/// The energy up to which a step is certified for a set that has a law without a largest slope.
struct PairLimit {
  std::uint32_t set = 0;  ///< index in NetworkDescription::sets
  double energy = 0.0;    ///< energy of the motion of two of its MATs against each other [J]
};

/// Up to how many others the members of a set may touch at once.
struct SetPartners {
  std::uint32_t set = 0;  ///< index in NetworkDescription::sets
  std::vector<std::uint32_t>
      partners;  ///< one number for each member, those of the first set first

  bool operator==(const SetPartners&) const = default;
};

/// Up to which the step of a network is certified where laws have no largest slope.
struct ReachLimit {
  /// The speed of a port [m/s].
  double speed = std::numeric_limits<double>::infinity();
  /// The kinetic and the stored energy of the whole scene [J]; infinite where every such law belongs
  /// to a set.
  double energy = std::numeric_limits<double>::infinity();
  std::vector<PairLimit> pairs{};  ///< one for each set with such a law
  /// The partners with which all this holds: those that the certificate needs.
  std::vector<SetPartners> partners{};
  /// The limits with more partners, in the order of these. The last has those that are certified.
  std::vector<ReachLimit> with_more_partners{};

  bool is_infinite() const noexcept {
    return energy == std::numeric_limits<double>::infinity() && pairs.empty();
  }
};

/// The Reach of the start, its energies raised by up to a million as long as the step is certified, to
/// a tenth. Where Lennard-Jones alone has no largest slope in a set, the energy of its pairs is raised
/// further: of all such sets together, then of one after the other. With more partners there are up to two limits,
/// the last with those of partner_limits(), which hold for the energies of the start. Infinite where every law has a largest
/// slope, and where the step is not certified. O(liaisons), and O(liaisons) for each set.
ReachLimit reach_limit(const engine::NetworkDescription& network);

/// For each set where Lennard-Jones alone has no largest slope, the energy of a pair at which K' + 2 Z' comes to 4
/// with the partners that the certificate needs, to 5 %. None where it is at 4 in the wells, and where the depth of a
/// well follows variables. O(liaisons).
std::vector<PairLimit> stable_pairs(const engine::NetworkDescription& network);

/// The most energy that the motion of two MATs of a set against each other has [J]. Of any two it is at
/// most their kinetic energy, and half the reduced mass times the sum of their speeds squared. Ports have
/// no kinetic energy. Real time: O(members), no allocation.
double pair_energy(const engine::World& world, const engine::SetLiaison& set) noexcept;

/// True if a port moves faster, or the scene has more energy, than the step is certified for with the
/// partners that the members of sets have now. Of the pairs of a set, pair_energy() counts; what a pair
/// stores does not, and shows when it parts. Real time: O(MATs + members of sets), no allocation.
/// @param energy  of the world now
bool is_beyond(const ReachLimit& limit, const engine::World& world,
               const engine::Energy& energy) noexcept;

}  // namespace cordis::plan
