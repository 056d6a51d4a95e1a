// sim_node/devices/real_devices.h -- the devices of a scene that move something real.
#pragma once

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "idl/gesture.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Knows which devices of the session a scene plays and are not simulated. One on standby counts, for
/// it may take over at any time.
class RealDevices {
 public:
  /// A device that a process of the session has described.
  struct Device {
    std::uint32_t id = 0;
    std::string name;
    std::string driver;
  };

  /// The scene that is played from now on; any thread.
  void play(const scene::Scene& scene);
  /// All devices that are there now; any thread.
  void update(std::vector<Device> devices);

  /// True if the scene plays one. Wait-free.
  bool are_played() const noexcept { return are_played_.load(std::memory_order_relaxed); }
  /// Names the first of them, as `'keys' (driver kfb1)`; empty when there is none. Any thread.
  std::string text() const;

 private:
  void evaluate();

  mutable std::mutex mutex_;
  std::set<std::uint32_t> played_;
  std::vector<Device> devices_;
  std::string text_;
  std::atomic<bool> are_played_{false};
};

}  // namespace cordis::sim
