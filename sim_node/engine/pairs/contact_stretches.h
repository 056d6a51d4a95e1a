// sim_node/engine/pairs/contact_stretches.h -- what contacts remember of their friction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// The springs of some contacts, each across its line of centres: one array for each value. Contacts are in
/// the order of their rows, and within a row in that of the later member.
struct StretchRows {
  const std::uint32_t* column = nullptr;  // of the later member
  const std::uint32_t* state = nullptr;   // the number of its state; null: 0
  const double* phase = nullptr;          // kSticks or kSlides
  const double* stretch[3] = {};          // [m]
  std::size_t count = 0;

  /// The square of the stretch of a contact [m^2].
  double square(std::size_t i) const noexcept {
    const double x = stretch[0][i];
    const double y = stretch[1][i];
    const double z = stretch[2][i];
    return x * x + y * y + z * z;
  }
};

/// A sum of 8 sums by the place, which fill vector registers.
struct SumByPlace {
  double sums[kPairBatch] = {};

  void add(const double* values) noexcept {
    for (std::size_t place = 0; place < kPairBatch; ++place) sums[place] += values[place];
  }
  double all() const noexcept {
    return ((sums[0] + sums[4]) + (sums[2] + sums[6])) +
           ((sums[1] + sums[5]) + (sums[3] + sums[7]));
  }
};

/// The contacts that push, row by row. A step reads the rows of the last one and writes its own
/// beside them; there is room for a number of contacts that make_room() enlarges between two steps.
class ContactStretches {
 public:
  ContactStretches() = default;
  ContactStretches(std::size_t row_count, std::size_t capacity);

  /// What was written is read from now on, and written again, row by row.
  void begin_step() noexcept;
  /// Forgets what was written since, and stands as before it.
  void take_back_step() noexcept;
  /// Contacts of the last step in the rows from `first` on, before `last`.
  StretchRows old_rows(std::size_t first, std::size_t last) const noexcept {
    return read_.rows(first, last);
  }
  /// Contacts of the last step before a row.
  std::size_t old_start(std::size_t row) const noexcept { return read_.start[row]; }
  /// Adds contacts to what is being written.
  /// @return how many there was room for; the others are forgotten.
  [[nodiscard]] std::size_t add(const StretchRows& contacts) noexcept;
  /// Ends a row, and all before it that have not been ended.
  void end_row(std::size_t row) noexcept { end_row_at(row, count()); }
  /// Likewise. @param end  contacts that are written up to its end
  void end_row_at(std::size_t row, std::size_t end) noexcept;

  std::size_t capacity() const noexcept { return capacity_; }
  /// Makes room for more. Allocates; without memory the room stays as it is.
  void make_room(std::size_t capacity) noexcept;
  std::size_t count() const noexcept { return written_.column.size(); }  ///< contacts written
  /// What is written, in its order.
  StretchRows written() const noexcept { return written_.rows(0, written_.start.size() - 1); }
  /// What is written of a row that has been ended.
  StretchRows row(std::size_t row) const noexcept { return written_.rows(row, row + 1); }
  /// The sum of the squares of what is written [m^2]. Cost: O(contacts).
  double sum_of_squares() const noexcept;
  /// Likewise: the sums of the rows, each by the number of the later member. Cost: O(contacts + rows).
  double sum_by_member() const noexcept;
  /// Values that a saved contact takes.
  static constexpr std::size_t kValuesPerPair = 5;

  /// What was written in the last step.
  /// @param first_later  the first member that may be the later one of a pair
  /// @param state_count  states that a contact may be in
  void serialize(Archive& archive, std::size_t first_later, std::size_t member_count,
                 std::size_t state_count);

 private:
  /// Arrays are reserved: room that nothing uses is not touched.
  struct Table {
    std::vector<std::size_t> start{0};  // by row; one past the last too
    std::vector<std::uint32_t> column;
    std::vector<std::uint32_t> state;
    std::vector<double> phase;
    std::array<std::vector<double>, 3> stretch;  // [m]

    StretchRows rows(std::size_t first, std::size_t last) const noexcept;
    template <class Do>
    void each_array(Do change) {
      change(column);
      change(state);
      change(phase);
      for (std::vector<double>& axis : stretch) change(axis);
    }
  };

  Table read_;
  Table written_;
  std::size_t capacity_ = 0;
  std::size_t ended_ = 0;  // rows
};

}  // namespace cordis::engine
