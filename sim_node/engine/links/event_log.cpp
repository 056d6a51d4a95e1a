// sim_node/engine/links/event_log.cpp
#include "sim_node/engine/links/event_log.h"

#include <numeric>

#include "node/assert.h"

namespace cordis::engine {

EventLog::EventLog(const StateTable& table, std::size_t capacity) : events_(capacity) {
  std::size_t first = 0;
  for (const StateMachine& state_machine : table.state_machines()) {
    const std::size_t state_count = state_machine.states.size();
    matrices_.push_back({first, state_count});
    first += state_count * state_count;
  }
  change_count_.assign(first, 0);
}

void EventLog::begin_step() noexcept {
  count_ = 0;
  lost_ = 0;
}

void EventLog::count(const LinkEvent& event) noexcept {
  ++change_count_[place(event.state_machine, event.from, event.to)];
  ++total_change_count_;
}

void EventLog::add(const LinkEvent& event) noexcept {
  count(event);
  if (count_ == events_.size()) {
    ++lost_;
    return;
  }
  events_[count_++] = event;
}

void EventLog::enter(std::size_t entered) noexcept {
  CORDIS_ASSERT(entered <= room().size());
  for (const LinkEvent& event : room().first(entered)) count(event);
  count_ += entered;
}

std::uint64_t EventLog::change_count(std::uint32_t state_machine, std::uint32_t from,
                                     std::uint32_t to) const noexcept {
  return change_count_[place(state_machine, from, to)];
}

void EventLog::serialize(Archive& archive) {
  archive.wholes(std::span(change_count_), [](std::size_t, std::uint64_t) { return true; });
  if (!archive.restores()) return;
  total_change_count_ =
      std::accumulate(change_count_.begin(), change_count_.end(), std::uint64_t{0});
  begin_step();
}

std::size_t EventLog::place(std::uint32_t state_machine, std::uint32_t from,
                            std::uint32_t to) const noexcept {
  const Matrix& matrix = matrices_[state_machine];
  return matrix.first + from * matrix.state_count + to;
}

}  // namespace cordis::engine
