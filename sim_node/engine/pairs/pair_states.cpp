// sim_node/engine/pairs/pair_states.cpp
#include "sim_node/engine/pairs/pair_states.h"

#include <algorithm>
#include <limits>
#include <new>
#include <span>
#include <utility>

#include "sim_node/engine/pairs/restored_rows.h"

namespace cordis::engine {

PairStates::PairStates(std::size_t row_count, std::size_t capacity, std::uint32_t slot_count)
    : slot_count_(slot_count) {
  for (Table* table : {&read_, &written_}) {
    table->start.assign(row_count + 1, 0);
    table->states.resize(capacity);
    table->memory.assign(capacity * slot_count, kNoValue);
  }
}

void PairStates::begin_step() noexcept {
  std::swap(read_, written_);
  written_.count = 0;
  has_rows_ = true;
}

bool PairStates::add(const PairState& state, const double* memory, std::size_t stride) noexcept {
  if (written_.count == written_.states.size()) return false;
  written_.states[written_.count] = state;
  for (std::size_t s = 0; s < slot_count_; ++s) {
    written_.memory[written_.count * slot_count_ + s] = memory[s * stride];
  }
  ++written_.count;
  return true;
}

std::size_t PairStates::keep_rows(std::size_t first, std::size_t last) noexcept {
  const std::size_t first_read = read_.start[first];
  const std::size_t first_written = written_.count;
  const std::size_t wanted = read_.start[last] - first_read;
  const std::size_t kept = std::min(wanted, written_.states.size() - first_written);
  std::copy_n(read_.states.data() + first_read, kept, written_.states.data() + first_written);
  std::copy_n(read_.memory.data() + first_read * slot_count_, kept * slot_count_,
              written_.memory.data() + first_written * slot_count_);
  written_.count += kept;
  for (std::size_t row = first; row < last; ++row) {
    written_.start[row + 1] = first_written + std::min(read_.start[row + 1] - first_read, kept);
  }
  return wanted - kept;
}

bool PairStates::make_room(std::size_t capacity) noexcept {
  if (capacity <= this->capacity()) return false;
  try {
    for (Table* table : {&read_, &written_}) {
      table->states.reserve(capacity);
      table->memory.reserve(capacity * slot_count_);
    }
  } catch (const std::bad_alloc&) {
    return false;
  }
  for (Table* table : {&read_, &written_}) {
    table->states.resize(capacity);
    table->memory.resize(capacity * slot_count_, kNoValue);
  }
  return true;
}

void PairStates::change_slots(std::uint32_t slot_count) {
  slot_count_ = slot_count;
  for (Table* table : {&read_, &written_}) {
    table->memory.assign(table->states.size() * slot_count, kNoValue);
  }
}

void PairStates::add_to(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < written_.count; ++i) {
    const PairState& pair = written_.states[i];
    hash.add(std::uint64_t{pair.column} << 32 | pair.state);
    for (const double value : {pair.rest_length, pair.tension, pair.impulse, pair.entered}) {
      hash.add(value);
    }
  }
  hash.add(std::uint64_t{written_.count});
}

void PairStates::serialize(Archive& archive, std::size_t first_later, std::size_t member_count,
                           const StateTable& table, std::uint32_t state_machine) {
  const std::size_t count = archive.count(written_.count, written_.states.size());
  archive.flag(has_rows_);
  RestoredRows rows(read_.start, count, first_later, member_count);  // free between two steps
  archive.wholes(std::span(written_.start), [&rows](std::size_t row, std::size_t start) {
    return rows.takes_start(row, start);
  });
  const auto fits = [&](std::size_t i, const PairState& pair) {
    return rows.takes_column(i, pair.column) && table.has_state(state_machine, pair.state);
  };
  archive.records(std::span(written_.states).first(count), fits, &PairState::column,
                  &PairState::state, &PairState::rest_length, &PairState::tension,
                  &PairState::impulse, &PairState::entered);
  archive.reals({written_.memory.data(), count * slot_count_});
  archive.hash_with([this](StateHash& hash) { add_to(hash); });
}

}  // namespace cordis::engine
