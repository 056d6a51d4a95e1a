// sim_node/engine/pairs/pair_states.h -- the states of the pairs of a set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/links/state_table.h"

namespace cordis::engine {

/// What a pair remembers from one step to the next, as in StateMachineRows.
struct PairState {
  std::uint32_t column = 0;  // of the later member
  StateIndex state = 0;
  double rest_length = 0.0;  // [m]
  double tension = 0.0;      // [N]
  double impulse = 0.0;      // [N s]
  double entered = 0.0;      // step count
};

/// The pairs that are in range or in another state than that of the start, row by row, each row
/// by the later member. A step reads the rows of the last one and writes its own beside them; there
/// is room for a number of pairs that make_room() enlarges between two steps.
class PairStates {
 public:
  PairStates(std::size_t row_count, std::size_t capacity, std::uint32_t slot_count);

  /// What was written is read from now on, and written again, row by row.
  void begin_step() noexcept;
  /// Pairs of a row in the last step: indices for old_state and old_memory.
  std::size_t old_begin(std::size_t row) const noexcept { return read_.start[row]; }
  std::size_t old_end(std::size_t row) const noexcept { return read_.start[row + 1]; }
  const PairState& old_state(std::size_t index) const noexcept { return read_.states[index]; }
  /// The value of a slot. Precondition: below the number of slots.
  double old_memory(std::size_t index, std::size_t slot) const noexcept {
    CORDIS_ASSERT(slot < slot_count_);
    return read_.memory[index * slot_count_ + slot];
  }

  /// Adds a pair to the row that is being written.
  /// @param memory  its slots, `stride` values apart
  /// @return false when there is no room: the pair is forgotten.
  [[nodiscard]] bool add(const PairState& state, const double* memory, std::size_t stride) noexcept;
  void end_row(std::size_t row) noexcept { written_.start[row + 1] = written_.count; }

  /// Writes rows [first, last) as they were in the last step. @return pairs that found no room
  [[nodiscard]] std::size_t keep_rows(std::size_t first, std::size_t last) noexcept;

  /// The pairs of a row as last written.
  std::size_t begin(std::size_t row) const noexcept { return written_.start[row]; }
  std::size_t end(std::size_t row) const noexcept { return written_.start[row + 1]; }
  const PairState& state(std::size_t index) const noexcept { return written_.states[index]; }
  /// Number of pair states for which memory is reserved.
  std::size_t capacity() const noexcept { return written_.states.size(); }
  /// Makes room for more. Allocates. @return false when there is room, or no memory
  bool make_room(std::size_t capacity) noexcept;
  /// The least number of values that a saved pair state takes.
  static constexpr std::size_t kValuesPerPair = 6;
  std::size_t count() const noexcept { return written_.count; }
  std::size_t row_count() const noexcept { return written_.start.size() - 1; }
  /// True if a step has been written.
  bool has_rows() const noexcept { return has_rows_; }

  /// Keeps the states, forgets what the slots remember, and makes room for others. Allocates.
  void change_slots(std::uint32_t slot_count);
  std::uint32_t slot_count() const noexcept { return slot_count_; }

  /// What was written in the last step.
  /// @param first_later    the first member that may be the later one of a pair
  /// @param state_machine  of these pairs
  void serialize(Archive& archive, std::size_t first_later, std::size_t member_count,
                 const StateTable& table, std::uint32_t state_machine);

 private:
  void add_to(StateHash& hash) const noexcept;

  struct Table {
    std::vector<std::size_t> start;  // by row; one past the last too
    std::vector<PairState> states;
    std::vector<double> memory;
    std::size_t count = 0;
  };

  std::uint32_t slot_count_;
  bool has_rows_ = false;
  Table read_;
  Table written_;
};

}  // namespace cordis::engine
