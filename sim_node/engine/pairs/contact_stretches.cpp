// sim_node/engine/pairs/contact_stretches.cpp
#include "sim_node/engine/pairs/contact_stretches.h"

#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include "node/assert.h"
#include "sim_node/engine/pairs/restored_rows.h"

namespace cordis::engine {
namespace {

/// A contact as a saved state has it.
struct SavedContact {
  std::uint32_t column = 0;
  std::uint32_t mode = 0;  // twice the number of its state, and 1 more while it slides
  double x = 0.0;          // [m]
  double y = 0.0;
  double z = 0.0;
};

SavedContact contact_at(const StretchRows& contacts, std::size_t i) noexcept {
  return {contacts.column[i], 2 * contacts.state[i] + (contacts.phase[i] == kSlides ? 1U : 0U),
          contacts.stretch[0][i], contacts.stretch[1][i], contacts.stretch[2][i]};
}

}  // namespace

StretchRows ContactStretches::Table::rows(std::size_t first, std::size_t last) const noexcept {
  const std::size_t from = start[first];
  return {column.data() + from,
          state.data() + from,
          phase.data() + from,
          {stretch[0].data() + from, stretch[1].data() + from, stretch[2].data() + from},
          start[last] - from};
}

ContactStretches::ContactStretches(std::size_t row_count, std::size_t capacity)
    : capacity_(capacity), ended_(row_count) {
  for (Table* table : {&read_, &written_}) {
    table->start.assign(row_count + 1, 0);
    table->each_array([capacity](auto& values) { values.reserve(capacity); });
  }
}

void ContactStretches::begin_step() noexcept {
  std::swap(read_, written_);
  written_.each_array([](auto& values) { values.clear(); });
  ended_ = 0;
}

void ContactStretches::take_back_step() noexcept {
  std::swap(read_, written_);
  ended_ = written_.start.size() - 1;
}

std::size_t ContactStretches::add(const StretchRows& contacts) noexcept {
  const std::size_t kept = std::min(contacts.count, capacity_ - count());
  const auto append = [kept](auto& values, const auto* from) {
    values.insert(values.end(), from, from + kept);  // within what is reserved
  };
  append(written_.column, contacts.column);
  if (contacts.state != nullptr) {
    append(written_.state, contacts.state);
  } else {
    written_.state.resize(written_.state.size() + kept, 0U);
  }
  append(written_.phase, contacts.phase);
  for (std::size_t axis = 0; axis < 3; ++axis)
    append(written_.stretch[axis], contacts.stretch[axis]);
  return kept;
}

void ContactStretches::end_row_at(std::size_t row, std::size_t end) noexcept {
  CORDIS_ASSERT(row + 1 < written_.start.size());
  for (; ended_ <= row; ++ended_) written_.start[ended_ + 1] = end;
}

void ContactStretches::make_room(std::size_t capacity) noexcept {
  if (capacity <= this->capacity()) return;
  try {
    for (Table* table : {&read_, &written_})
      table->each_array([capacity](auto& values) { values.reserve(capacity); });
  } catch (const std::bad_alloc&) {
    return;
  }
  capacity_ = capacity;
}

double ContactStretches::sum_of_squares() const noexcept {
  const StretchRows all = written();
  SumByPlace sum;
  const std::size_t whole = all.count - all.count % kPairBatch;
  for (std::size_t i = 0; i < whole; i += kPairBatch) {
    for (std::size_t place = 0; place < kPairBatch; ++place)
      sum.sums[place] += all.square(i + place);
  }
  for (std::size_t i = whole; i < all.count; ++i) sum.sums[i - whole] += all.square(i);
  return sum.all();
}

double ContactStretches::sum_by_member() const noexcept {
  SumByPlace sum;
  for (std::size_t a = 0; a + 1 < written_.start.size(); ++a) {
    const StretchRows of_row = row(a);
    SumByPlace squares;
    for (std::size_t i = 0; i < of_row.count; ++i)
      squares.sums[of_row.column[i] / 4 % kPairBatch] += of_row.square(i);
    sum.add(squares.sums);
  }
  return sum.all();
}

void ContactStretches::serialize(Archive& archive, std::size_t first_later,
                                 std::size_t member_count, std::size_t state_count) {
  std::size_t written = this->count();
  const std::size_t count = archive.count(written, capacity_);
  RestoredRows rows(read_.start, count, first_later, member_count);  // free between two steps
  archive.wholes(std::span(written_.start), [&rows](std::size_t row, std::size_t start) {
    return rows.takes_start(row, start);
  });
  std::vector<SavedContact> contacts;
  if (archive.saves()) {
    for (std::size_t i = 0; i < count; ++i) contacts.push_back(contact_at(this->written(), i));
  }
  if (archive.restores()) contacts.resize(count);
  const auto fits = [&](std::size_t i, const SavedContact& contact) {
    return rows.takes_column(i, contact.column) && contact.mode < 2 * state_count;
  };
  archive.records(std::span(contacts.data(), count), fits, &SavedContact::column,
                  &SavedContact::mode, &SavedContact::x, &SavedContact::y, &SavedContact::z);
  if (archive.restores()) {
    written_.each_array([](auto& values) { values.clear(); });
    for (const SavedContact& contact : contacts) {
      written_.column.push_back(contact.column);
      written_.state.push_back(contact.mode / 2);
      written_.phase.push_back(contact.mode % 2 != 0 ? kSlides : kSticks);
      written_.stretch[0].push_back(contact.x);
      written_.stretch[1].push_back(contact.y);
      written_.stretch[2].push_back(contact.z);
    }
  }
  archive.hash_with([this](StateHash& hash) {
    const StretchRows all = this->written();
    for (std::size_t i = 0; i < all.count; ++i) {
      const SavedContact contact = contact_at(all, i);
      hash.add(std::uint64_t{contact.column} << 32 | contact.mode);
      for (const double value : {contact.x, contact.y, contact.z}) hash.add(value);
    }
    hash.add(std::uint64_t{all.count});
  });
}

}  // namespace cordis::engine
