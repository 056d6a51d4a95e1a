// sim_node/devices/device_reach.h -- how far the numbers of a device are believed.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "idl/gesture.h"

namespace cordis::sim {

/// The largest numbers that the samples of a device may hold, for each of its coordinates. Whoever
/// takes part in a session may write a sample: a number beyond these is taken for the bound.
struct DeviceReach {
  static constexpr std::size_t kCoordinates = msg::MAX_AXES;
  static constexpr double kFarthest = 2.0;      ///< no hand reaches farther [m]
  static constexpr double kStrongest = 1000.0;  ///< and none is stronger [N]
  /// Stops give, sensors err, and a coordinate of an end-effector map supports more together with the
  /// others.
  static constexpr double kTravelShare = 1.25;
  static constexpr double kForceShare = 2.0;

  /// Reach of a device without a description.
  DeviceReach() noexcept {
    travel_m.fill(kFarthest);
    lowest_m.fill(-kFarthest);
    highest_m.fill(kFarthest);
    force_n.fill(kStrongest);
  }

  std::array<double, kCoordinates> travel_m{};  ///< from the rest, in either direction
  std::array<double, kCoordinates> lowest_m{};  ///< ends of the travel, from the rest
  std::array<double, kCoordinates> highest_m{};
  std::array<double, kCoordinates> force_n{};  ///< force of the hand, in either direction
};

/// What a device reports of its travel and its forces. A number of it that makes no sense, or says
/// more than a hand is capable of, leaves the bound of an unknown device.
DeviceReach reach_of(const msg::DeviceDescription& description) noexcept;

/// The reaches of the devices of a session, by device and epoch of its process. One thread writes,
/// any number reads, and neither waits for the other.
class ReachTable {
 public:
  /// The first description of an epoch is believed. Of more than kRows the one is forgotten that has
  /// not been put or found for longest: a device that plays stays, however often others restart.
  void put(std::uint32_t device_id, std::uint64_t epoch, const DeviceReach& reach) noexcept;

  /// The process of this epoch is alive: its device counts as found.
  void keep(std::uint64_t epoch) const noexcept;

  /// True if the device has described its reach. Real time: no lock.
  bool knows(std::uint32_t device_id, std::uint64_t epoch) const noexcept;

  /// Reach of a device; that of an unknown one before its description. Real time: no lock.
  DeviceReach find(std::uint32_t device_id, std::uint64_t epoch) const noexcept;

 private:
  static constexpr std::size_t kRows = 64;

  struct Row {
    std::atomic<std::uint64_t> epoch{0};  ///< 0 while the row is empty or being written
    std::atomic<std::uint32_t> device_id{0};
    mutable std::atomic<std::uint64_t> used{0};  ///< count of uses_ at its newest use
    std::array<std::atomic<double>, DeviceReach::kCoordinates> travel_m{};
    std::array<std::atomic<double>, DeviceReach::kCoordinates> lowest_m{};
    std::array<std::atomic<double>, DeviceReach::kCoordinates> highest_m{};
    std::array<std::atomic<double>, DeviceReach::kCoordinates> force_n{};
  };
  std::array<Row, kRows> rows_;
  mutable std::atomic<std::uint64_t> uses_{0};
};

}  // namespace cordis::sim
