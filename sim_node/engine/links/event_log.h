// sim_node/engine/links/event_log.h -- the changes of state of one step, and how often each kind
// happened.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/links/link_event.h"
#include "sim_node/engine/links/state_table.h"

namespace cordis::engine {

/// Takes what changes during a step; its room is fixed at construction.
class EventLog {
 public:
  EventLog(const StateTable& table, std::size_t capacity);

  /// Forgets the events of the last step. Real time: O(1), no allocation.
  void begin_step() noexcept;

  /// Enters a change, and counts it. Real time: O(1), no allocation.
  void add(const LinkEvent& event) noexcept;

  /// Room that no event has yet: of links, one for each. Written by several threads, then entered by one.
  std::span<LinkEvent> room() noexcept { return std::span(events_).subspan(count_); }
  /// Enters the first events of the room, and counts them. Precondition: it has so many.
  /// Real time: O(count), no allocation.
  void enter(std::size_t count) noexcept;

  std::span<const LinkEvent> events() const noexcept { return {events_.data(), count_}; }
  std::uint32_t lost() const noexcept { return lost_; }  ///< changes without room in this step
  /// How often a state machine went from a state to another since step 0.
  std::uint64_t change_count(std::uint32_t state_machine, std::uint32_t from,
                             std::uint32_t to) const noexcept;
  /// How often any of them changed since step 0. Real time: O(1).
  std::uint64_t total_change_count() const noexcept { return total_change_count_; }

  /// The counts. One that is restored has no events.
  void serialize(Archive& archive);

 private:
  struct Matrix {
    std::size_t first;        // of its counts: from * state_count + to
    std::size_t state_count;  // of the state machine
  };

  void count(const LinkEvent& event) noexcept;
  std::size_t place(std::uint32_t state_machine, std::uint32_t from,
                    std::uint32_t to) const noexcept;

  std::vector<LinkEvent> events_;
  std::size_t count_ = 0;
  std::uint32_t lost_ = 0;
  std::vector<Matrix> matrices_;  // one per state machine
  std::vector<std::uint64_t> change_count_;
  std::uint64_t total_change_count_ = 0;  // their sum
};

}  // namespace cordis::engine
