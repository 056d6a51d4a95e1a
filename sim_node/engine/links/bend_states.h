// sim_node/engine/links/bend_states.h -- the states of the bends of a world that have them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/links/bend_angle.h"
#include "sim_node/engine/links/state_kernel.h"
#include "sim_node/engine/links/state_table.h"

namespace cordis::engine {

/// What one step makes of the states of bends.
struct BendChange {
  std::uint32_t row = 0;
  StateIndex from = 0;
  StateIndex to = 0;
  Quantity quantity = Quantity::kNone;
  double value = 0.0;
  double rest_before = 0.0;  // [rad]
};

/// State machines of bends: one row for each bend that has states, in the order of the bends.
class BendStates {
 public:
  BendStates(const NetworkDescription& description, const StateTable& table);

  std::size_t count() const noexcept { return row_count_; }
  /// Angle and rate of a row for the next call of step(); the rate is per step [rad].
  void set_angle(std::uint32_t row, const AngleAndRate& angle) noexcept;
  /// Tests the exits of all rows and changes their states. Real time: O(rows), no allocation.
  /// @param on_change  called for each row that changed, in order
  template <class OnChange>
  void step(const StateKernel& kernel, const StateTable& table, std::uint64_t step,
            OnChange on_change) noexcept {
    for (std::size_t first = 0; first < state_.size(); first += kStateBatch) {
      StateMachineRows rows;
      step_batch(kernel, table, step, first, rows);
      if (rows.changed == 0) continue;
      for (std::size_t i = 0; i < kStateBatch; ++i) {
        if ((rows.changed >> i & 1U) != 0) on_change(change_of(table, rows, first, i));
      }
    }
    any_forced_ = false;
  }

  /// Precondition of these: the row exists.
  double rest_angle(std::uint32_t row) const noexcept { return rest_angle_[row]; }
  void set_rest_angle(std::uint32_t row, double angle) noexcept { rest_angle_[row] = angle; }
  double moment(std::uint32_t row) const noexcept { return moment_[row]; }
  void set_moment(std::uint32_t row, double moment) noexcept { moment_[row] = moment; }
  StateIndex state_index(std::uint32_t row) const noexcept { return state_[row]; }
  std::uint32_t state_of(const StateTable& table, std::uint32_t row) const noexcept;
  std::uint32_t state_machine(std::uint32_t row) const noexcept { return state_machine_[row]; }
  double age(std::uint32_t row, std::uint64_t step) const noexcept {
    return (static_cast<double>(step) - entered_[row]) * dt_;
  }
  void force_state(const StateTable& table, std::uint32_t row, std::uint32_t state) noexcept;
  /// Fits what the rows remember to a table that has been changed. Allocates.
  void adopt(const StateTable& table);
  void serialize(Archive& archive, const StateTable& table);

 private:
  void step_batch(const StateKernel& kernel, const StateTable& table, std::uint64_t step,
                  std::size_t first, StateMachineRows& rows) noexcept;
  BendChange change_of(const StateTable& table, const StateMachineRows& rows, std::size_t first,
                       std::size_t i) noexcept;

  int dimension_;
  double dt_;  // [s]
  std::size_t row_count_;
  AlignedVector<std::uint32_t> state_machine_;  // all arrays: padded to a multiple of kStateBatch
  AlignedVector<StateIndex> state_;
  AlignedVector<double> rest_angle_;  // [rad]
  AlignedVector<double> moment_;      // of the last step [N m]
  AlignedVector<double> entered_;     // step count
  AlignedVector<std::uint32_t> forced_;
  AlignedVector<double> angle_;      // [rad]
  AlignedVector<double> increment_;  // of the angle in this step [rad]
  AlignedVector<double> memory_;     // slot_count_ x 8 values for each batch
  std::size_t slot_count_ = 0;
  bool any_forced_ = false;
};

}  // namespace cordis::engine
