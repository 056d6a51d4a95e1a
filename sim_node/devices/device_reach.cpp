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

/// Ends of the travel of a coordinate: those that all coordinates have, else as far as its travel to
/// either side.
void set_ends(const msg::DeviceDescription& description, std::size_t c,
              DeviceReach& reach) noexcept {
  constexpr double kFarthest = DeviceReach::kFarthest;
  const double lowest = description.lowest_m();
  const double highest = description.highest_m();
  if (lowest <= 0.0 && highest >= 0.0 && lowest < highest) {
    reach.lowest_m[c] = std::max(lowest, -kFarthest);
    reach.highest_m[c] = std::min(highest, kFarthest);
    return;
  }
  reach.highest_m[c] = bound(description.travel_m()[c], 1.0, kFarthest);
  reach.lowest_m[c] = -reach.highest_m[c];
}

}  // namespace

DeviceReach reach_of(const msg::DeviceDescription& description) noexcept {
  DeviceReach reach;
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    reach.travel_m[c] =
        bound(description.travel_m()[c], DeviceReach::kTravelShare, DeviceReach::kFarthest);
    reach.force_n[c] =
        bound(description.force_n()[c], DeviceReach::kForceShare, DeviceReach::kStrongest);
    set_ends(description, c, reach);
  }
  return reach;
}

void ReachTable::put(std::uint32_t device_id, std::uint64_t epoch,
                     const DeviceReach& reach) noexcept {
  const auto is_known = [device_id, epoch](const Row& row) {
    return row.epoch.load(kRelaxed) == epoch && row.device_id.load(kRelaxed) == device_id;
  };
  if (epoch == 0 || std::any_of(rows_.begin(), rows_.end(), is_known)) return;
  Row& row =
      *std::ranges::min_element(rows_, {}, [](const Row& old) { return old.used.load(kRelaxed); });
  row.epoch.store(0, kRelaxed);
  row.used.store(uses_.fetch_add(1, kRelaxed) + 1, kRelaxed);
  // Whoever reads one of these values sees that the row has no epoch, too.
  row.device_id.store(device_id, std::memory_order_release);
  for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
    row.travel_m[c].store(reach.travel_m[c], std::memory_order_release);
    row.lowest_m[c].store(reach.lowest_m[c], std::memory_order_release);
    row.highest_m[c].store(reach.highest_m[c], std::memory_order_release);
    row.force_n[c].store(reach.force_n[c], std::memory_order_release);
  }
  row.epoch.store(epoch, std::memory_order_release);
}

void ReachTable::keep(std::uint64_t epoch) const noexcept {
  for (const Row& row : rows_) {
    if (row.epoch.load(kRelaxed) == epoch)
      row.used.store(uses_.fetch_add(1, kRelaxed) + 1, kRelaxed);
  }
}

bool ReachTable::knows(std::uint32_t device_id, std::uint64_t epoch) const noexcept {
  return std::any_of(rows_.begin(), rows_.end(), [device_id, epoch](const Row& row) {
    return row.epoch.load(std::memory_order_acquire) == epoch &&
           row.device_id.load(kRelaxed) == device_id;
  });
}

DeviceReach ReachTable::find(std::uint32_t device_id, std::uint64_t epoch) const noexcept {
  for (const Row& row : rows_) {
    if (epoch == 0 || row.epoch.load(std::memory_order_acquire) != epoch) continue;
    if (row.device_id.load(kRelaxed) != device_id) continue;
    row.used.store(uses_.fetch_add(1, kRelaxed) + 1, kRelaxed);
    DeviceReach reach;
    for (std::size_t c = 0; c < DeviceReach::kCoordinates; ++c) {
      reach.travel_m[c] = row.travel_m[c].load(std::memory_order_acquire);
      reach.lowest_m[c] = row.lowest_m[c].load(std::memory_order_acquire);
      reach.highest_m[c] = row.highest_m[c].load(std::memory_order_acquire);
      reach.force_n[c] = row.force_n[c].load(std::memory_order_acquire);
    }
    if (row.epoch.load(kRelaxed) == epoch) return reach;  // not overwritten meanwhile
  }
  return {};
}

}  // namespace cordis::sim
