// device_node/port_assignment.cpp
#include "device_node/port_assignment.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace cordis::device {
namespace {

static_assert(static_cast<int>(Role::kMass) == msg::ROLE_MASS);
static_assert(static_cast<int>(Role::kLiaison) == msg::ROLE_LIAISON);

constexpr std::size_t kLongestName = 64;

/// A name that another process wrote, as it may be shown.
std::string shown(const std::string& name) {
  std::string text = name.substr(0, kLongestName);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

std::string trouble_with(const msg::PortDescription& port, const DeviceConfig& device) {
  if (port.role() != msg::ROLE_MASS && port.role() != msg::ROLE_LIAISON) {
    return fmt::format("port '{}' gives device '{}' the unknown role {}", shown(port.name()),
                       device.name, static_cast<std::uint32_t>(port.role()));
  }
  for (const std::uint32_t axis : port.axes()) {
    const int count = device.end_effector_map.coordinate_count();
    if (axis >= static_cast<std::uint32_t>(count)) {
      return fmt::format("port '{}' wants axis {} of device '{}', which has {} (axes 0 to {})",
                         shown(port.name()), axis, device.name, count, count - 1);
    }
  }
  return {};
}

}  // namespace

PortAssignment part_of(const msg::SceneDescription& scene, const DeviceConfig& device,
                       const Driver& driver) {
  PortAssignment part;
  for (const msg::PortDescription& port : scene.ports()) {
    if (port.device_id() != device.device_id) continue;
    part.impossible = trouble_with(port, device);
    const Role role = port.role() == msg::ROLE_LIAISON ? Role::kLiaison : Role::kMass;
    if (part.impossible.empty() && part.wanted && role != part.role) {
      part.impossible =
          fmt::format("port '{}' gives device '{}' role {}, another port role {}",
                      shown(port.name()), device.name, name_of(role), name_of(part.role));
    }
    part.wanted = true;
    part.role = role;
    if (!part.impossible.empty()) break;
  }
  if (!part.wanted) return part;

  if (part.impossible.empty() && !driver.can_play(part.role)) {
    part.impossible =
        fmt::format("device '{}' cannot play role {}: its driver '{}' has nothing to give in it",
                    device.name, name_of(part.role), device.driver);
  }
  if (!part.impossible.empty()) {
    part.impossible = fmt::format("scene '{}': {}", shown(scene.name()), part.impossible);
  }
  const double rate_hz = device.layout.rate_hz;
  if (std::abs(scene.gesture_rate_hz() - rate_hz) > 1e-9 * rate_hz) {
    part.questionable =
        fmt::format("scene '{}' counts on {} gestures per second, device '{}' gives {}",
                    shown(scene.name()), scene.gesture_rate_hz(), device.name, rate_hz);
  }
  return part;
}

}  // namespace cordis::device
