// sim_node/engine/pairs/contact_stretches.h -- what contacts remember of their friction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/vec.h"

namespace cordis::engine {

/// The spring of a contact, across its line of centres.
struct ContactStretch {
  std::uint32_t column = 0;  // of the later member
  std::uint32_t mode = 0;    // twice the number of its state, and 1 more while it slides
  double x = 0.0;            // [m]
  double y = 0.0;
  double z = 0.0;
};

/// The contacts that push, row by row, each row by the later member. A step reads the rows
/// of the last one and writes its own beside them; there is room for a number of contacts that
/// make_room() enlarges between two steps.
class ContactStretches {
 public:
  ContactStretches() = default;
  ContactStretches(std::size_t row_count, std::size_t capacity);

  /// What was written is read from now on, and written again, row by row.
  void begin_step() noexcept;
  /// Forgets what was written since, and stands as before it.
  void take_back_step() noexcept;
  /// Contacts of a row in the last step.
  const ContactStretch* old_begin(std::size_t row) const noexcept {
    return read_.contacts.data() + read_.start[row];
  }
  const ContactStretch* old_end(std::size_t row) const noexcept {
    return read_.contacts.data() + read_.start[row + 1];
  }
  /// Adds a contact to the row that is being written.
  /// @return false when there is no room: the contact is forgotten.
  [[nodiscard]] bool add(const ContactStretch& contact) noexcept {
    if (written_.contacts.size() == capacity()) return false;
    written_.contacts.push_back(contact);
    written_.sum_of_squares +=
        contact.x * contact.x + contact.y * contact.y + contact.z * contact.z;
    return true;
  }
  /// Ends a row, and all before it that have not been ended.
  void end_row(std::size_t row) noexcept;

  std::size_t capacity() const noexcept { return capacity_; }
  /// Makes room for more. Allocates; without memory the room stays as it is.
  void make_room(std::size_t capacity) noexcept;
  /// The sum of the squares of what is written, in its order [m^2].
  double sum_of_squares() const noexcept { return written_.sum_of_squares; }
  /// What is written, in its order.
  std::span<const ContactStretch> written() const noexcept { return written_.contacts; }
  /// What is written of a row that has been ended.
  std::span<const ContactStretch> row(std::size_t row) const noexcept {
    const std::size_t begin = written_.start[row];
    return written().subspan(begin, written_.start[row + 1] - begin);
  }
  /// Values that a saved contact takes.
  static constexpr std::size_t kValuesPerPair = 5;

  /// What was written in the last step.
  /// @param first_later  the first member that may be the later one of a pair
  /// @param state_count  states that a contact may be in
  void serialize(Archive& archive, std::size_t first_later, std::size_t member_count,
                 std::size_t state_count);

 private:
  struct Table {
    std::vector<std::size_t> start{0};     // by row; one past the last too
    std::vector<ContactStretch> contacts;  // reserved: room that nothing uses is not touched
    double sum_of_squares = 0.0;           // [m^2]
  };

  Table read_;
  Table written_;
  std::size_t capacity_ = 0;
  std::size_t ended_ = 0;  // rows
};

}  // namespace cordis::engine
