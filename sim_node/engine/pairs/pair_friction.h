// sim_node/engine/pairs/pair_friction.h -- the friction of the contacts of a set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/pairs/contact_stretches.h"
#include "sim_node/engine/pairs/pair_block.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// Steps the friction of the contacts of a set: see Friction. The force acts on the centres of the two
/// members, the same on both: it keeps the momentum, and not the angular momentum, for balls do not
/// turn.
class PairFriction {
 public:
  /// @param capacity        contacts there is room for at first
  /// @param block_capacity  that of the blocks it is given
  PairFriction(const NetworkDescription& description, const SetLiaison& set, std::size_t capacity,
               std::size_t block_capacity);

  /// True if there is friction.
  bool acts() const noexcept { return term_.stiffness > 0.0; }
  /// Takes other parameters. Precondition: acts() stays as it was.
  void adopt(const Friction& friction) noexcept;

  void begin_step() noexcept;
  /// Finds the forces of a block whose tensions have been found. Precondition: acts().
  FrictionRows step(const PairKernel& kernel, const MemberColumns& members,
                    PairBlock& block) noexcept;
  /// After all blocks of a step. @return by how much the energy stored in its springs has grown [J]
  double end_step() noexcept;

  double stored_energy() const noexcept { return stored_; }  ///< in its springs [J]
  /// Contacts of this step that could not be remembered, for lack of room.
  std::uint32_t forgotten() const noexcept { return forgotten_; }
  std::size_t capacity() const noexcept { return stretches_.capacity(); }
  /// Makes room for so many contacts. Allocates; without memory the room stays as it is.
  void make_room(std::size_t capacity) noexcept { stretches_.make_room(capacity); }

  /// Nothing unless it acts.
  void serialize(Archive& archive, std::size_t first_later, std::size_t member_count);

 private:
  enum Array : std::size_t {
    kStretchX,
    kStretchY,
    kStretchZ,
    kPhase,
    kForceX,
    kForceY,
    kForceZ,
    kArrayCount
  };

  double* array(std::size_t which) noexcept { return values_.data() + which * block_capacity_; }
  FrictionRows rows() noexcept;
  void recall(PairBlock& block) noexcept;
  void remember(PairBlock& block) noexcept;
  double energy_of_springs() const noexcept {
    return 0.5 * term_.stiffness * stretches_.sum_of_squares();
  }

  double dt_;
  std::size_t row_count_;
  std::size_t block_capacity_;
  FrictionTerm term_;
  ContactStretches stretches_;
  double stored_ = 0.0;  // [J]
  std::uint32_t forgotten_ = 0;
  AlignedVector<double> values_;  // kArrayCount arrays of the block
};

}  // namespace cordis::engine
