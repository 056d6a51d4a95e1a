// sim_node/engine/pair_behaviours.h -- the behaviour of the pairs of a row of a set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/aligned_vector.h"
#include "sim_node/engine/behaviour_kernel.h"
#include "sim_node/engine/event_log.h"
#include "sim_node/engine/network.h"
#include "sim_node/engine/pair_kernel.h"
#include "sim_node/engine/pair_states.h"
#include "sim_node/engine/state_table.h"

namespace cordis::engine {

/// What is the same for all pairs of a step.
struct PairStep {
  const StateTable& table;
  const BehaviourKernel& behaviours;
  EventLog& log;
  std::uint64_t step;  // step count
  bool frozen;         // before step 0: no exit is tested, nothing is remembered
};

/// Rest length of a pair [m]: given, or the sum of two radii.
struct PairRest {
  double given = 0.0;
  const double* radius = nullptr;  // of each member; null when the rest length is given

  double of(std::size_t a, std::size_t b) const noexcept {
    return radius == nullptr ? given : radius[a] + radius[b];
  }
};

/// Steps the behaviour of pairs, whatever its law and states. A pair remembers its state while it
/// is in range, and as long as it is in another state than that of the start.
class PairBehaviours {
 public:
  /// @param capacity  pairs in range or bound there is room for
  PairBehaviours(const NetworkDescription& description, const SetLiaison& set,
                 const StateTable& table, std::size_t capacity);

  /// Fits what is remembered to a table that has been changed. Allocates.
  void adopt(const StateTable& table);

  void begin_step(const PairStep& step) noexcept;
  /// Finds the pulls of row a. The row holds its pairs in range; it is given those besides that
  /// are bound. @return how many there are then; what was found of them is in factor() and
  /// viscous_factor().
  std::size_t step_row(const PairKernel& kernel, const PairStep& step, const MemberColumns& members,
                       std::size_t a, std::size_t count, double range_square, const PairRest& rest,
                       const PairRow& row) noexcept;
  const double* factor() const noexcept { return array(kPull); }  ///< pull / distance [N/m]
  /// Of the part that stores no energy.
  const double* viscous_factor() const noexcept { return array(kElastic); }

  bool has_states() const noexcept { return !stateless_; }
  const PairStates& states() const noexcept { return states_; }
  PairStates& states() noexcept { return states_; }
  StateIndex start_state() const noexcept { return start_; }
  double switching() const noexcept { return switching_; }  ///< by the changes of this step [J]
  /// Pairs of this step that could not be remembered, for lack of room.
  std::uint32_t forgotten() const noexcept { return forgotten_; }

 private:
  enum Array : std::size_t {
    kRest,
    kPull,
    kElastic,
    kElongation,
    kImpulse,
    kEntered,
    kSpeed,
    kSpeedX,
    kSpeedY,
    kSpeedZ,
    kSlip,
    kAge,
    kMassA,
    kMassB,
    kArrayCount
  };

  double* array(Array which) noexcept { return values_.data() + which * row_size_; }
  const double* array(Array which) const noexcept { return values_.data() + which * row_size_; }
  std::size_t add_bound(const PairKernel& kernel, const MemberColumns& members, std::size_t a,
                        std::size_t count, const PairRow& row) noexcept;
  void recall(std::size_t a, std::size_t count, const PairRest& rest, const PairStep& step,
              const PairRow& row) noexcept;
  void find_quantities(const MemberColumns& members, std::size_t a, std::size_t count,
                       const PairStep& step, const PairRow& row) noexcept;
  void step_batch(const PairStep& step, std::size_t a, std::size_t i, const PairRow& row) noexcept;
  void note_changes(const PairStep& step, std::size_t a, std::size_t i, const PairRow& row,
                    const BehaviourRows& rows) noexcept;
  void remember(std::size_t a, std::size_t count, double range_square, const PairRow& row) noexcept;

  std::uint32_t behaviour_;
  double dt_;
  std::size_t row_count_;
  std::vector<std::uint32_t> mat_;  // of each member
  std::vector<double> mass_;        // of each member [kg]; 0 unless a mass
  std::size_t row_size_;
  bool stateless_ = true;
  bool needs_velocity_ = false;
  bool needs_mass_ = false;
  bool needs_impulse_ = false;
  StateIndex start_ = 0;
  StateIndex padding_ = 0;
  std::size_t capacity_;
  PairStates states_;
  double switching_ = 0.0;
  std::uint32_t forgotten_ = 0;
  AlignedVector<StateIndex> state_;      // of the row
  AlignedVector<double> values_;         // kArrayCount arrays of the row
  AlignedVector<double> memory_;         // of pair i, slot s: [(i / 8 * slots + s) * 8 + i % 8]
  AlignedVector<std::uint32_t> merged_;  // columns
};

}  // namespace cordis::engine
