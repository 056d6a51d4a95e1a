// sim_node/devices/undescribed_devices.cpp
#include "sim_node/devices/undescribed_devices.h"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/time.h"

namespace cordis::sim {
namespace {

constexpr std::int64_t kGrace = 1'000'000'000;  // for a description that is under way [ns]
constexpr std::int64_t kGone = 2'000'000'000;   // since the newest sample of a device [ns]

/// Finds the row of a process.
auto is_of(std::uint32_t device_id, std::uint64_t epoch) noexcept {
  return [device_id, epoch](const auto& row) {
    return row.epoch.load(std::memory_order_relaxed) == epoch &&
           row.device_id.load(std::memory_order_relaxed) == device_id;
  };
}

}  // namespace

void UndescribedDevices::play(const scene::Scene& scene) {
  const std::lock_guard lock(mutex_);
  names_.clear();
  for (const scene::Port& port : scene.ports) names_[port.device_id] = port.device;
}

void UndescribedDevices::record(std::uint32_t device_id, std::uint64_t epoch, bool for_good,
                                std::int64_t now_nsec) noexcept {
  if (epoch == 0) return;
  Row* row = std::ranges::find_if(rows_, is_of(device_id, epoch));
  if (row == rows_.end()) {
    row = &rows_[next_++ % kRows];
    row->epoch.store(0, std::memory_order_relaxed);
    // Whoever reads one of these values sees that the row has no epoch, too.
    row->device_id.store(device_id, std::memory_order_release);
    row->for_good.store(false, std::memory_order_release);
    row->first_nsec.store(now_nsec, std::memory_order_release);
  }
  row->newest_nsec.store(now_nsec, std::memory_order_relaxed);
  if (for_good) row->for_good.store(true, std::memory_order_relaxed);
  row->epoch.store(epoch, std::memory_order_release);
}

bool UndescribedDevices::is_recorded_for_good(std::uint32_t device_id,
                                              std::uint64_t epoch) const noexcept {
  const Row* row = std::ranges::find_if(rows_, is_of(device_id, epoch));
  return row != rows_.end() && row->for_good.load(std::memory_order_relaxed);
}

/// Says that a device sends and was not described in time; empty for any other row. Precondition:
/// the lock is held.
std::string UndescribedDevices::sentence_of(const Row& row, std::int64_t now_nsec) const {
  const std::uint64_t epoch = row.epoch.load(std::memory_order_acquire);
  const auto name = names_.find(row.device_id.load(std::memory_order_relaxed));
  if (epoch == 0 || name == names_.end()) return {};
  if (now_nsec - row.newest_nsec.load(std::memory_order_relaxed) > kGone) return {};
  const bool for_good = row.for_good.load(std::memory_order_relaxed);
  const bool is_late = now_nsec - row.first_nsec.load(std::memory_order_relaxed) > kGrace;
  if (!for_good && (!is_late || reaches_.knows(name->first, epoch))) return {};
  if (row.epoch.load(std::memory_order_relaxed) != epoch) return {};  // overwritten meanwhile
  const std::string who = "device '" + name->second + "' ";
  const std::string result = ": its limits are unknown, and it is given no force";
  return for_good ? who + "sent samples before a device/description that makes sense" + result +
                        " until it starts again"
                  : who + "sends samples and no device/description that makes sense" + result;
}

void UndescribedDevices::report() {
  const std::int64_t now = node::monotonic_nsec();
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const Row& row : rows_) {
    const std::string sentence = sentence_of(row, now);
    if (!sentence.empty()) text += (text.empty() ? "" : "; ") + sentence;
  }
  if (text != text_ && !text.empty() && refusals_.record(now)) spdlog::error("{}", text);
  text_ = std::move(text);
  refusals_.report(now);
}

std::string UndescribedDevices::text() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

}  // namespace cordis::sim
