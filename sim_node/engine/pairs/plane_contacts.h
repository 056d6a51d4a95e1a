// sim_node/engine/pairs/plane_contacts.h -- balls on planes, in one pass over the balls.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/step_kernel.h"
#include "sim_node/engine/pairs/contact_stretches.h"
#include "sim_node/engine/pairs/pair_kernel.h"
#include "sim_node/engine/pairs/plane_kernel.h"
#include "sim_node/engine/pairs/surface_neighbours.h"

namespace cordis::engine {

/// Force on a member of a set in the last step [N]; the fourth value counts partners.
struct ForceOnMember {
  double all[4] = {};
  double viscous[4] = {};  // the part that stores no energy
};

/// The pairs of a set between planes with one side and balls, whose contact is one spring and one damper,
/// with friction or without. Each batch of 8 balls is taken once: places, pairs with all planes near it,
/// friction, works and forces. The bits are those of the steps for any surface, which take each of these by
/// itself. Where one plane is near a batch, the force on a ball is kept as its part along the normal and its
/// friction.
class PlaneContacts {
 public:
  /// Empty unless the set acts on planes with one side alone, kMaxOfBatches at most; with friction, on as
  /// many as have room for the springs of all balls.
  PlaneContacts(const NetworkDescription& network, const SetLiaison& set);

  bool empty() const noexcept { return planes_.empty(); }

  /// Takes the positions of the balls that are listed, and gives them the forces of this step. Writes the
  /// forces of the planes to their members alone.
  /// Real time: O(balls that are listed * planes near them), no allocation.
  /// Preconditions: it is not empty; no plane moves in this step; `surfaces` is measured for these positions.
  /// @param friction  not used without friction
  /// @param members   of the set, with the moves of the planes
  PlaneWorks step(const PairKernel& kernel, const LinearPair& pair, const FrictionTerm& friction,
                  const SurfaceNeighbours& surfaces, const ForceColumns& columns,
                  const MemberValues& members) noexcept;

  /// The most contacts that there can be; 0 without friction.
  std::size_t max_springs() const noexcept { return phase_.size(); }
  /// The springs of friction stand here, and not in a ContactStretches.
  bool holds_springs() const noexcept { return holds_springs_; }
  /// Takes the springs of the last step. Real time: O(members * planes), no allocation.
  /// Precondition: there is friction.
  void take_springs(const ContactStretches& springs) noexcept;
  /// Writes the springs of the last step, which stand there from now on. Real time: likewise.
  /// Preconditions: holds_springs(); there is room for max_springs().
  void return_springs(ContactStretches& springs) noexcept;
  /// Likewise, and keeps them.
  void write_springs(ContactStretches& springs) const noexcept;

  /// The forces of the last step stand here, and not in MemberValues, until they are written.
  bool holds(std::size_t member) const noexcept {
    return !empty() && member >= planes_.size() && held_plane_[member / kPairBatch] != kNoPlane;
  }
  /// Force on a member, and the number of its partners [N]. Precondition: holds(member).
  ForceOnMember force(std::size_t member, bool has_viscous) const noexcept;
  /// Writes what it holds. Real time: O(members), no allocation.
  void write_forces(const MemberValues& members) noexcept;
  /// The forces of the last step stand in MemberValues.
  void forget() noexcept { std::fill(held_plane_.begin(), held_plane_.end(), kNoPlane); }

 private:
  PlaneFriction friction_rows() noexcept;

  double range_ = 0.0;                   // [m]
  std::vector<PlaneRow> planes_;         // of each surface
  std::vector<PlaneSum> sums_;           // likewise, empty between steps
  AlignedVector<std::uint32_t> column_;  // of the MAT of each member, padded
  std::vector<std::uint8_t> is_run_;     // see PlaneBalls
  AlignedVector<double> radius_;  // of each member, padded; empty when the rest length is given [m]
  std::vector<std::uint8_t> masses_;      // likewise
  std::vector<std::uint8_t> held_plane_;  // see PlaneBalls
  AlignedVector<double> factor_;
  AlignedVector<double> viscous_factor_;
  bool holds_springs_ = false;
  AlignedVector<double> phase_;              // see PlaneFriction; empty without friction
  AlignedVector<double> stretch_[3];         // likewise [m]
  AlignedVector<double> friction_force_[3];  // likewise [N]
};

}  // namespace cordis::engine
