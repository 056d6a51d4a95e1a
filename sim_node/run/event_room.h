// sim_node/run/event_room.h -- changes of state on their way from the world to a message.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/links/link_event.h"

namespace cordis::sim {

/// Keeps events in the order they came, up to a fixed number; counts the others. Real time:
/// everything but the constructor allocates nothing and does not throw.
class EventRoom {
 public:
  static constexpr std::size_t kMinEvents = 4096;
  static constexpr std::size_t kMaxEvents = 65536;

  EventRoom() = default;
  /// Room for two changes of every link, within kMinEvents and kMaxEvents.
  explicit EventRoom(std::size_t state_link_count)
      : events_(std::clamp(2 * state_link_count, kMinEvents, kMaxEvents)) {}

  void clear() noexcept {
    count_ = 0;
    lost_ = 0;
  }
  /// @param lost_before  events that the world itself had no room for
  void add(std::span<const engine::LinkEvent> events, std::uint32_t lost_before) noexcept {
    const std::size_t taken = std::min(events.size(), events_.size() - count_);
    std::copy_n(events.begin(), taken, events_.begin() + static_cast<std::ptrdiff_t>(count_));
    count_ += taken;
    lost_ += lost_before + (events.size() - taken);
  }

  std::span<const engine::LinkEvent> events() const noexcept { return {events_.data(), count_}; }
  std::uint64_t lost() const noexcept { return lost_; }
  bool is_empty() const noexcept { return count_ == 0 && lost_ == 0; }
  bool is_half_full() const noexcept { return 2 * count_ >= events_.size(); }

 private:
  std::vector<engine::LinkEvent> events_;
  std::size_t count_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace cordis::sim
