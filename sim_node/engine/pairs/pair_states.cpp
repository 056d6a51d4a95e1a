// sim_node/engine/pairs/pair_states.cpp
#include "sim_node/engine/pairs/pair_states.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace cordis::engine {
namespace {

constexpr std::size_t kValuesOfState = 6;

}  // namespace

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
  const std::size_t from = read_.start[first];
  const std::size_t to = written_.count;
  const std::size_t wanted = read_.start[last] - from;
  const std::size_t kept = std::min(wanted, written_.states.size() - to);
  std::copy_n(read_.states.data() + from, kept, written_.states.data() + to);
  std::copy_n(read_.memory.data() + from * slot_count_, kept * slot_count_,
              written_.memory.data() + to * slot_count_);
  written_.count += kept;
  for (std::size_t row = first; row < last; ++row) {
    written_.start[row + 1] = to + std::min(read_.start[row + 1] - from, kept);
  }
  return wanted - kept;
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
    hash.add(static_cast<std::uint64_t>(pair.column) << 32 | pair.state);
    for (const double value : {pair.rest_length, pair.pull, pair.impulse, pair.entered}) {
      hash.add(value);
    }
  }
  hash.add(static_cast<std::uint64_t>(written_.count));
}

void PairStates::append_state(std::vector<double>& state) const {
  state.push_back(static_cast<double>(written_.count));
  state.push_back(has_rows_ ? 1.0 : 0.0);
  for (const std::size_t start : written_.start) state.push_back(static_cast<double>(start));
  for (std::size_t i = 0; i < written_.count; ++i) {
    const PairState& pair = written_.states[i];
    state.insert(state.end(), {static_cast<double>(pair.column), static_cast<double>(pair.state),
                               pair.rest_length, pair.pull, pair.impulse, pair.entered});
  }
  state.insert(state.end(), written_.memory.begin(),
               written_.memory.begin() + static_cast<std::ptrdiff_t>(written_.count * slot_count_));
}

std::size_t PairStates::max_values() const noexcept {
  return 2 + written_.start.size() + written_.states.size() * (kValuesOfState + slot_count_);
}

std::size_t PairStates::size_of_state(const double* state, std::size_t available) const noexcept {
  if (available == 0) return 0;
  if (!(state[0] >= 0.0 && state[0] <= static_cast<double>(written_.states.size()))) return 0;
  const std::size_t size = 2 + written_.start.size() +
                           static_cast<std::size_t>(state[0]) * (kValuesOfState + slot_count_);
  return size <= available ? size : 0;
}

const double* PairStates::take_state(const double* state) noexcept {
  written_.count = static_cast<std::size_t>(*state++);
  has_rows_ = *state++ != 0.0;
  for (std::size_t& start : written_.start) start = static_cast<std::size_t>(*state++);
  for (std::size_t i = 0; i < written_.count; ++i) {
    written_.states[i] = {static_cast<std::uint32_t>(state[0]),
                          static_cast<StateIndex>(state[1]),
                          state[2],
                          state[3],
                          state[4],
                          state[5]};
    state += kValuesOfState;
  }
  const std::size_t memory = written_.count * slot_count_;
  std::copy_n(state, memory, written_.memory.begin());
  return state + memory;
}

}  // namespace cordis::engine
