// sim_node/devices/device_reach.cpp
#include "sim_node/devices/device_reach.h"

#include <algorithm>

namespace cordis::sim {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

/// A bound of the description, or the one of an unknown device.
double bound(double described, double share, double unknown) noexcept {
  return described > 0.0 && described * share < unknown ? described * share : unknown;
}

}  // namespace

DeviceReach reach_of(const msg::DeviceDescription& description) noexcept {
  DeviceReach reach;
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    reach.travel_m[c] =
        bound(description.travel_m()[c], DeviceReach::kTravelShare, DeviceReach::kFarthest);
    reach.force_n[c] =
        bound(description.force_n()[c], DeviceReach::kForceShare, DeviceReach::kStrongest);
  }
  return reach;
}

void ReachTable::put(std::uint32_t device_id, std::uint64_t epoch,
                     const DeviceReach& reach) noexcept {
  const auto is_known = [device_id, epoch](const Row& row) {
    return row.epoch.load(kRelaxed) == epoch && row.device_id.load(kRelaxed) == device_id;
  };
  if (epoch == 0 || std::any_of(rows_.begin(), rows_.end(), is_known)) return;
  Row& row = rows_[next_++ % kRows];
  row.epoch.store(0, kRelaxed);
  // Whoever reads one of these values sees that the row has no epoch, too.
  row.device_id.store(device_id, std::memory_order_release);
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    row.travel_m[c].store(reach.travel_m[c], std::memory_order_release);
    row.force_n[c].store(reach.force_n[c], std::memory_order_release);
  }
  row.epoch.store(epoch, std::memory_order_release);
}

DeviceReach ReachTable::find(std::uint32_t device_id, std::uint64_t epoch) const noexcept {
  for (const Row& row : rows_) {
    if (epoch == 0 || row.epoch.load(std::memory_order_acquire) != epoch) continue;
    if (row.device_id.load(kRelaxed) != device_id) continue;
    DeviceReach reach;
    for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
      reach.travel_m[c] = row.travel_m[c].load(std::memory_order_acquire);
      reach.force_n[c] = row.force_n[c].load(std::memory_order_acquire);
    }
    if (row.epoch.load(kRelaxed) == epoch) return reach;  // not overwritten meanwhile
  }
  return {};
}

}  // namespace cordis::sim
