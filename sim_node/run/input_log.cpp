// sim_node/run/input_log.cpp
#include "sim_node/run/input_log.h"

#include <algorithm>
#include <utility>

#include "idl/inputs.h"

namespace cordis::sim {
namespace {

bool same(const DeviceReach& a, const DeviceReach& b) noexcept {
  return a.travel_m == b.travel_m && a.lowest_m == b.lowest_m && a.highest_m == b.highest_m &&
         a.force_n == b.force_n;
}

}  // namespace

InputLog::InputLog() : records_(kRoom) {}

bool InputLog::is_half_full() const noexcept {
  return 2 * (head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_relaxed)) >=
         kRoom;
}

InputRecord* InputLog::next(InputRecord::Kind kind) noexcept {
  const std::uint64_t number = ++number_;
  const std::uint64_t head = head_.load(std::memory_order_relaxed);
  if (head - tail_.load(std::memory_order_acquire) >= kRoom) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  InputRecord& record = records_[head % kRoom];
  record.kind = kind;
  record.number = number;
  record.turn = turn();
  record.step = 0;
  return &record;
}

bool InputLog::take(InputRecord& record) noexcept {
  const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
  if (tail == head_.load(std::memory_order_acquire)) return false;
  record =
      std::move(records_[tail % kRoom]);  // and with it the command, which the loop never frees
  tail_.store(tail + 1, std::memory_order_release);
  return true;
}

void InputLog::record_reach(std::uint32_t device_id, const DeviceReach& reach) noexcept {
  auto known = std::ranges::find_if(reaches_, [device_id](const KnownReach& row) {
    return row.is_known && row.device_id == device_id;
  });
  if (known != reaches_.end() && same(known->reach, reach)) return;
  if (known == reaches_.end()) known = reaches_.begin() + (next_reach_++ % kDevices);
  *known = {device_id, reach, true};
  const std::pair<msg::ReachBound, const std::array<double, DeviceReach::kCoordinates>*> bounds[] =
      {{msg::REACH_TRAVEL, &reach.travel_m},
       {msg::REACH_LOWEST, &reach.lowest_m},
       {msg::REACH_HIGHEST, &reach.highest_m},
       {msg::REACH_FORCE, &reach.force_n}};
  for (const auto& [bound, values] : bounds) {
    InputRecord* record = next(InputRecord::Kind::kReach);
    if (record == nullptr) continue;
    record->device_id = device_id;
    record->bound = static_cast<std::uint8_t>(bound);
    record->value = *values;
    push();
  }
}

template <class Sample>
void InputLog::record_sample(InputRecord::Kind kind, const Sample& sample, bool is_supported,
                             const DeviceReach& reach, double work_j,
                             const std::array<double, msg::MAX_AXES>& value) noexcept {
  record_reach(sample.device_id(), reach);
  InputRecord* record = next(kind);
  if (record == nullptr) return;
  record->device_id = sample.device_id();
  record->is_supported = is_supported;
  record->epoch = sample.epoch();
  record->sample = sample.sample();
  record->answered_epoch = sample.answered_epoch();
  record->answered_sample = sample.answered_sample();
  record->time_nsec = sample.time_nsec();
  record->axis_count = sample.axis_count();
  record->work_j = work_j;
  record->value = value;
  push();
}

void InputLog::sample(const msg::GesturePositions& sample, bool is_supported,
                      const DeviceReach& reach) noexcept {
  record_sample(InputRecord::Kind::kPositions, sample, is_supported, reach, 0.0,
                sample.position_m());
}

void InputLog::sample(const msg::GestureForces& sample, bool is_supported,
                      const DeviceReach& reach) noexcept {
  record_sample(InputRecord::Kind::kForces, sample, is_supported, reach, sample.work_j(),
                sample.force_n());
}

void InputLog::command(const Request& request) noexcept {
  if (!request.done || request.source == nullptr) return;
  InputRecord* record = next(InputRecord::Kind::kCommand);
  if (record == nullptr) return;
  record->step = request.step;
  record->command = request.source;
  push();
}

void InputLog::hold() noexcept {
  if (next(InputRecord::Kind::kHold) != nullptr) push();
}

void InputLog::repeat(std::uint32_t device_id) noexcept {
  InputRecord* record = next(InputRecord::Kind::kRepeat);
  if (record == nullptr) return;
  record->device_id = device_id;
  push();
}

void InputLog::let_go(PassedBound bound, std::uint64_t step) noexcept {
  InputRecord* record = next(InputRecord::Kind::kLetGo);
  if (record == nullptr) return;
  record->bound = static_cast<std::uint8_t>(bound);
  record->step = step;
  push();
}

}  // namespace cordis::sim
