// sim_node/devices/device_reach.cpp
#include "sim_node/devices/device_reach.h"

#include <algorithm>

namespace cordis::sim {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

/// A bound that is told, or the one of an unknown device.
double bound(double told, double share, double unknown) noexcept {
  return told > 0.0 && told * share < unknown ? told * share : unknown;
}

}  // namespace

DeviceReach reach_of(const msg::DeviceDescription& told) noexcept {
  DeviceReach reach;
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    reach.travel_m[c] =
        bound(told.travel_m()[c], DeviceReach::kTravelShare, DeviceReach::kFarthest);
    reach.force_n[c] = bound(told.force_n()[c], DeviceReach::kForceShare, DeviceReach::kStrongest);
  }
  return reach;
}

void ReachTable::put(std::uint32_t device_id, std::uint64_t run,
                     const DeviceReach& reach) noexcept {
  const auto is_known = [device_id, run](const Row& row) {
    return row.run.load(kRelaxed) == run && row.device_id.load(kRelaxed) == device_id;
  };
  if (run == 0 || std::any_of(rows_.begin(), rows_.end(), is_known)) return;
  Row& row = rows_[next_++ % kRows];
  row.run.store(0, kRelaxed);
  // Whoever reads one of these values sees that the row has no run, too.
  row.device_id.store(device_id, std::memory_order_release);
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    row.travel_m[c].store(reach.travel_m[c], std::memory_order_release);
    row.force_n[c].store(reach.force_n[c], std::memory_order_release);
  }
  row.run.store(run, std::memory_order_release);
}

DeviceReach ReachTable::find(std::uint32_t device_id, std::uint64_t run) const noexcept {
  for (const Row& row : rows_) {
    if (run == 0 || row.run.load(std::memory_order_acquire) != run) continue;
    if (row.device_id.load(kRelaxed) != device_id) continue;
    DeviceReach reach;
    for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
      reach.travel_m[c] = row.travel_m[c].load(std::memory_order_acquire);
      reach.force_n[c] = row.force_n[c].load(std::memory_order_acquire);
    }
    if (row.run.load(kRelaxed) == run) return reach;  // not overwritten meanwhile
  }
  return {};
}

}  // namespace cordis::sim
