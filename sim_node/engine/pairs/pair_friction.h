// sim_node/engine/pairs/pair_friction.h -- the friction of the contacts of a set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
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

  /// True if there is friction in any state.
  bool acts() const noexcept { return acts_; }
  /// Takes other parameters. Allocates. Precondition: acts() stays as it was.
  /// @param shows_slid  true if conditions ask for Quantity::kSlid
  void adopt(const StateMachine& state_machine, bool shows_slid);

  /// Takes the coefficients that follow variables. Real time: O(states), no allocation.
  void take_parameters(const StateTable& table, StateIndex first_state) noexcept;

  /// @param frozen  before the start: contacts of the start hold, and nothing is remembered
  void begin_step(bool frozen) noexcept;
  /// True if it acts in this step: in a frozen one, if there are contacts of the start.
  bool acts_now() const noexcept { return acts_now_; }
  /// Loads what each contact of a padded block remembers, 0 of a new one. Precondition: acts_now().
  /// @return the stretch of each spring as the last step ended [m]; null unless it is asked for
  const double* recall(PairBlock& block) noexcept;
  /// Finds the forces of a block that was recalled, and whose tensions have been found.
  /// Precondition: acts_now().
  /// @param states  that of each pair in this step, counted from that of the machine numbered
  ///                `first_state`; null where it has but one
  FrictionRows step(const PairKernel& kernel, const MemberColumns& members,
                    const StateIndex* states, StateIndex first_state, PairBlock& block) noexcept;
  /// After all blocks of a step. @return by how much the energy stored in its springs has grown [J]
  double end_step() noexcept;

  /// A step that PlaneContacts have done. Precondition: acts(), with one friction in all states.
  /// @param squares  of the springs, see PlaneWorks [m^2] @return as end_step()
  double end_step_on_planes(double squares) noexcept;
  /// The term of all contacts. Precondition: acts(), and there is one state.
  const FrictionTerm& term() const noexcept { return terms_.front(); }
  ContactStretches& springs() noexcept { return stretches_; }

  double stored_energy() const noexcept { return stored_; }  ///< in its springs [J]
  /// Contacts of this step that could not be remembered, for lack of room.
  std::uint32_t forgotten() const noexcept { return forgotten_; }
  std::size_t capacity() const noexcept { return stretches_.capacity(); }
  /// Makes room for so many contacts. Allocates; without memory the room stays as it is.
  void make_room(std::size_t capacity) noexcept { stretches_.make_room(capacity); }

  /// The contacts of the last step, by their members.
  std::vector<StartStretch> contacts() const { return contacts_in(stretches_); }
  std::vector<StartStretch> contacts_in(const ContactStretches& springs) const;

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
    kSlid,
    kStateBefore,
    kTerms,  // the parts of FrictionTerm, one array each
    kArrayCount = kTerms + 5
  };

  double* array(std::size_t which) noexcept { return values_.data() + which * block_capacity_; }
  FrictionRows rows() noexcept;
  void begin_with(const std::vector<StartStretch>& contacts, StateIndex start);
  /// The number of the state of a pair.
  std::size_t state_of(const StateIndex* states, StateIndex first_state,
                       std::size_t pair) const noexcept {
    return states == nullptr ? 0 : states[pair] - first_state;
  }
  FrictionTermRows take_states(const StateIndex* states, StateIndex first_state,
                               PairBlock& block) noexcept;
  bool are_as_before(const StretchRows& old, PairBlock& block) const noexcept;
  void take_old(const StretchRows& old, std::size_t from, std::size_t count,
                std::size_t to) noexcept;
  void take_old_row(std::size_t row, PairBlock& block) noexcept;
  void remember(const StateIndex* states, StateIndex first_state, PairBlock& block) noexcept;
  double energy_of_springs() const noexcept;

  double dt_;
  std::size_t row_count_;
  std::size_t block_capacity_;
  bool acts_;
  bool acts_now_ = false;
  bool is_frozen_ = false;
  bool shows_slid_ = false;
  bool is_one_ = true;  // the same friction in all states
  bool unit_vectors_;
  std::vector<FrictionTerm> terms_;  // by state
  ContactStretches stretches_;
  double stored_ = 0.0;  // [J]
  std::uint32_t forgotten_ = 0;
  AlignedVector<double> values_;       // kArrayCount arrays of the block
  std::vector<std::uint32_t> column_;  // of those pairs of the block that are contacts
  std::vector<std::uint32_t> state_;   // likewise
};

}  // namespace cordis::engine
