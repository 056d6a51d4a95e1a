// sim_node/devices/real_devices.cpp
#include "sim_node/devices/real_devices.h"

#include <utility>

#include "node/time_scale.h"

namespace cordis::sim {

void RealDevices::play(const scene::Scene& scene) {
  const std::lock_guard lock(mutex_);
  played_.clear();
  for (const scene::Port& port : scene.ports) played_.insert(port.device_id);
  evaluate();
}

void RealDevices::update(std::vector<Device> devices) {
  const std::lock_guard lock(mutex_);
  devices_ = std::move(devices);
  evaluate();
}

/// Precondition: the lock is held.
void RealDevices::evaluate() {
  text_.clear();
  for (const Device& device : devices_) {
    if (!played_.contains(device.id) || node::is_simulated_driver(device.driver)) continue;
    text_ = "'" + device.name + "' (driver " + device.driver + ")";
    break;
  }
  are_played_.store(!text_.empty(), std::memory_order_relaxed);
}

std::string RealDevices::text() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

}  // namespace cordis::sim
