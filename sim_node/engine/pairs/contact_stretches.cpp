// sim_node/engine/pairs/contact_stretches.cpp
#include "sim_node/engine/pairs/contact_stretches.h"

#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/pairs/restored_rows.h"

namespace cordis::engine {

ContactStretches::ContactStretches(std::size_t row_count, std::size_t capacity)
    : capacity_(capacity), ended_(row_count) {
  for (Table* table : {&read_, &written_}) {
    table->start.assign(row_count + 1, 0);
    table->contacts.reserve(capacity);
  }
}

void ContactStretches::begin_step() noexcept {
  std::swap(read_, written_);
  written_.contacts.clear();
  written_.sum_of_squares = 0.0;
  ended_ = 0;
}

void ContactStretches::take_back_step() noexcept {
  std::swap(read_, written_);
  ended_ = written_.start.size() - 1;
}

void ContactStretches::end_row(std::size_t row) noexcept {
  CORDIS_ASSERT(row + 1 < written_.start.size());
  for (; ended_ <= row; ++ended_) written_.start[ended_ + 1] = written_.contacts.size();
}

void ContactStretches::make_room(std::size_t capacity) noexcept {
  if (capacity <= this->capacity()) return;
  try {
    for (Table* table : {&read_, &written_}) table->contacts.reserve(capacity);
  } catch (const std::bad_alloc&) {
    return;
  }
  capacity_ = capacity;
}

void ContactStretches::serialize(Archive& archive, std::size_t first_later,
                                 std::size_t member_count, std::size_t state_count) {
  std::size_t written = written_.contacts.size();
  const std::size_t count = archive.count(written, capacity_);
  if (archive.restores()) written_.contacts.resize(count);
  RestoredRows rows(read_.start, count, first_later, member_count);  // free between two steps
  archive.wholes(std::span(written_.start), [&rows](std::size_t row, std::size_t start) {
    return rows.takes_start(row, start);
  });
  const auto fits = [&](std::size_t i, const ContactStretch& contact) {
    return rows.takes_column(i, contact.column) && contact.mode < 2 * state_count;
  };
  archive.records(std::span(written_.contacts.data(), count), fits, &ContactStretch::column,
                  &ContactStretch::mode, &ContactStretch::x, &ContactStretch::y,
                  &ContactStretch::z);
  if (archive.restores()) {
    written_.sum_of_squares = 0.0;
    for (const ContactStretch& contact : written_.contacts) {
      written_.sum_of_squares +=
          contact.x * contact.x + contact.y * contact.y + contact.z * contact.z;
    }
  }
  archive.hash_with([this](StateHash& hash) {
    for (const ContactStretch& contact : written_.contacts) {
      hash.add(std::uint64_t{contact.column} << 32 | contact.mode);
      for (const double value : {contact.x, contact.y, contact.z}) hash.add(value);
    }
    hash.add(std::uint64_t{written_.contacts.size()});
  });
}

}  // namespace cordis::engine
