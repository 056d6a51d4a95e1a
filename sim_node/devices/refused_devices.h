// sim_node/devices/refused_devices.h -- devices that have joined the session and do not support the
// scene.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "idl/gesture.h"
#include "node/repeated_event.h"
#include "sim_node/checks/port_check.h"

namespace cordis::sim {

/// Holds every device that says what it is against the scene that is played, whichever comes first.
/// A device that does not support it is refused: it is given no force, and its MATs hold still.
class RefusedDevices {
 public:
  /// @param delay_periods  of the wire
  explicit RefusedDevices(int delay_periods) : delay_periods_(delay_periods) {}

  /// The scene that is played from now on.
  void play(const scene::Scene& scene);

  /// A device tells what it is; not believed when a number in it makes no sense, or when the same
  /// process has told something before. @return whether it is believed
  bool receive(const msg::DeviceDescription& description);

  /// Tells what has repeated itself. To be called at least now and then.
  void report_repeats();

  /// True if the process of this epoch is refused. Real time.
  [[nodiscard]] bool refuses(std::uint64_t epoch) const noexcept;

  /// Why, a sentence per port of the devices that are refused; empty when none is.
  std::string text() const;

 private:
  struct Known {
    std::uint32_t device_id = 0;
    std::uint64_t epoch = 0;
    std::string driver;
    config::DeviceLimits limits;
  };
  void evaluate();

  static constexpr std::size_t kMaxRefused = 32;  // refused at once; sessions have a few devices
  static constexpr std::size_t kMaxKnown = 64;

  int delay_periods_;
  mutable std::mutex mutex_;
  std::vector<PortDemand> demands_;
  std::deque<Known> known_;  // the newest ones, oldest first
  std::string text_;
  node::RepeatedEvent refusals_{"other devices that do not support the scene", spdlog::level::err};
  node::RepeatedEvent returns_{"every device supported the scene again", spdlog::level::info};
  std::array<std::atomic<std::uint64_t>, kMaxRefused> refused_{};  // epochs; 0: none
};

}  // namespace cordis::sim
