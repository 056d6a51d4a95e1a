// sim_node/engine/pairs/pair_state_machines.h -- the state machine of the pairs of a set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/event_log.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"
#include "sim_node/engine/pairs/pair_block.h"
#include "sim_node/engine/pairs/pair_kernel.h"
#include "sim_node/engine/pairs/pair_states.h"

namespace cordis::engine {

/// What is the same for all pairs of a step.
struct PairStep {
  const StateTable& table;
  const StateKernel& state_machines;
  EventLog& log;
  std::uint64_t step;  // step count
  bool frozen;         // before step 0: no exit is tested, nothing is remembered
  bool sums_contacts;  // for the contact forces of this step
};

/// Rest length of a pair [m]: given, or the sum of two radii.
struct PairRest {
  double fixed = 0.0;
  const double* radius = nullptr;  // of each member; null when the rest length is given

  double length(std::size_t a, std::size_t b) const noexcept {
    return radius == nullptr ? fixed : radius[a] + radius[b];
  }
};

/// Steps the state machine of pairs, whatever its law and states. A pair remembers its state while it
/// is in range, and as long as it is in another state than that of the start.
class PairStateMachines {
 public:
  /// @param capacity        pairs in range or bound there is room for
  /// @param block_capacity  that of the blocks it is given
  PairStateMachines(const NetworkDescription& description, const SetLiaison& set,
                    const StateTable& table, std::size_t capacity, std::size_t block_capacity);

  /// Fits what is remembered to a table that has been changed. Allocates.
  void adopt(const StateTable& table);

  void begin_step(const PairStep& step) noexcept;
  /// The columns of row a in range, with those that are bound beyond it, in their order; none when
  /// nothing is bound beyond it. They may be read with a batch more.
  std::span<const std::uint32_t> with_bound(const PairStep& step, std::size_t a, std::size_t count,
                                            const PairRow& row) noexcept;
  /// Finds the tensions of a padded block whose pairs have been measured. It holds the rest lengths
  /// that new pairs have.
  /// @param slid  of each pair, see Quantity::kSlid; null without friction [m]
  void step(const PairStep& step, const MemberColumns& members, const double* slid,
            const PairRest& rest, double range, PairBlock& block) noexcept;

  /// Adds what parameters that follow variables bring into the pairs of a block that are in range or bound.
  /// What they bring into such pairs at their range is taken off. Called by step(), or for a block that has none.
  void add_parameter_energy(const PairStep& step, const PairRest& rest, double range,
                            PairBlock& block) noexcept;
  /// Brought so in this step [J].
  double parameter_energy() const noexcept { return parameter_energy_; }

  /// Rows that are left out of a step remember what they did.
  void keep_rows(const PairStep& step, std::size_t first, std::size_t last) noexcept {
    if (remembers(step)) forgotten_ += static_cast<std::uint32_t>(states_.keep_rows(first, last));
  }

  /// True if a pair was in another state than that of the start as the last step ended.
  bool is_bound(std::size_t a, std::uint32_t column) const noexcept;

  /// Makes room for so many pairs. Allocates; without memory the room stays as it is.
  void make_room(std::size_t capacity) noexcept {
    if (states_.make_room(capacity)) capacity_ = states_.capacity();
  }

  bool has_states() const noexcept { return !stateless_; }
  const PairStates& states() const noexcept { return states_; }
  PairStates& states() noexcept { return states_; }
  StateIndex start_state() const noexcept { return start_; }
  /// The states of the pairs of the block of the last step(). Null where there is but one.
  const StateIndex* states_of_block() const noexcept {
    return stateless_ ? nullptr : state_.data();
  }
  /// Shows the pairs that are in another state than that of the start, with their first member.
  template <class Visit>
  void visit_bound(Visit visit) const {
    if (stateless_) return;
    for (std::size_t a = 0; a < states_.row_count(); ++a) {
      for (std::size_t i = states_.begin(a); i < states_.end(a); ++i) {
        if (states_.state(i).state != start_) visit(a, states_.state(i));
      }
    }
  }
  /// Masses of two members. Precondition: they exist.
  EndMasses masses_of(std::size_t a, std::size_t b) const noexcept {
    CORDIS_ASSERT(a < mass_.size() && b < mass_.size());
    return {mass_[a], mass_[b]};
  }
  double switching() const noexcept { return switching_; }  ///< by the changes of this step [J]
  /// Pairs of this step that could not be remembered, for lack of room.
  std::uint32_t forgotten() const noexcept { return forgotten_; }
  /// True if pairs have states that a step may change.
  bool remembers(const PairStep& step) const noexcept { return !stateless_ && !step.frozen; }

 private:
  enum Array : std::size_t {
    kTension,
    kElastic,
    kElongation,
    kImpulse,
    kEntered,
    kSpeed,
    kSpeedX,
    kSpeedY,
    kSpeedZ,
    kSlip,
    kNotSlid,
    kAge,
    kMassA,
    kMassB,
    kArrayCount
  };

  double* array(Array which) noexcept { return values_.data() + which * block_capacity_; }
  double* memory_of(std::size_t pair) noexcept {
    if (memory_.empty()) return nullptr;
    return memory_.data() + pair / kPairBatch * states_.slot_count() * kPairBatch +
           pair % kPairBatch;
  }
  double linear_parameter_energy(const PairStep& step, const PairRest& rest, double range,
                                 PairBlock& block) const noexcept;
  void find_masses(const PairRows& rows) noexcept;
  void find_velocities(const MemberColumns& members, const PairRows& rows) noexcept;
  void find_plain_tensions(const PairStep& step, PairBlock& block) noexcept;
  void recall(const PairStep& step, PairBlock& block) noexcept;
  void begin_pair(std::size_t pair, StateIndex state, const PairStep& step) noexcept;
  void find_quantities(const PairStep& step, PairBlock& block) noexcept;
  void step_batches(const PairStep& step, const double* slid, PairBlock& block) noexcept;
  void record_changes(const PairStep& step, std::size_t i, const PairRows& pairs,
                      const StateMachineRows& rows) noexcept;
  void remember(double range_square, PairBlock& block) noexcept;
  void find_factors(double range_square, PairBlock& block) noexcept;

  std::uint32_t state_machine_;
  double dt_;
  std::size_t row_count_;
  std::vector<std::uint32_t> mat_;  // of each member
  std::vector<double> mass_;        // of each member [kg]; 0 unless a mass
  std::size_t block_capacity_;
  bool stateless_ = true;
  bool needs_velocity_ = false;
  bool needs_mass_ = false;
  bool needs_impulse_ = false;
  bool asks_for_variable_ = false;  // the elasticity of a state does
  StateIndex start_ = 0;
  StateIndex padding_ = 0;
  std::size_t capacity_;
  PairStates states_;
  double switching_ = 0.0;
  double parameter_energy_ = 0.0;  // [J]
  std::uint32_t forgotten_ = 0;
  AlignedVector<StateIndex> state_;      // of each pair of the block
  AlignedVector<double> values_;         // kArrayCount arrays of the block
  AlignedVector<double> memory_;         // of pair i, slot s: [(i / 8 * slots + s) * 8 + i % 8]
  AlignedVector<std::uint32_t> merged_;  // columns
};

}  // namespace cordis::engine
