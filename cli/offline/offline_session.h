// cli/offline/offline_session.h -- a launch file or a scene played in one process, with its
// simulated devices, without DDS and without clocks.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device_node/drivers/pointer_port.h"
#include "device_node/exchange.h"
#include "idl/scene.h"
#include "sim_node/run/event_room.h"
#include "sim_node/run/loaded_scene.h"
#include "sim_node/sim_config.h"

namespace cordis::cli {

/// The scene of a launch file and all its devices, with their own drivers and guards, in lockstep:
/// what a run of the processes computes, bit for bit.
class OfflineSession {
 public:
  /// A device whose driver is hardware stays away, its ports at rest.
  /// @param file       a launch file; or a scene, whose ports all rest
  /// @param overrides  of a launch file, as on the command line of `cordis run`
  /// @throws config::ConfigError with all problems of the files; UsageError for overrides of a scene,
  /// and for a launch file without a sim_node.
  explicit OfflineSession(const std::string& file, const std::vector<std::string>& overrides = {});
  ~OfflineSession();

  /// Plays on until so much time is simulated since the start. @param after_tick  called once per gesture period
  /// @throws std::runtime_error when the scene diverges.
  void play_until(double time_s, const std::function<void()>& after_tick = {});

  /// Plays one gesture period. @param after_step  called after each of its steps
  /// @return false when the scene has diverged in one of them, which after_step did not see:
  /// sim::Simulation::failure().
  bool play_tick(const std::function<void()>& after_step = {});

  /// True if so much time is simulated since the start, in whole gesture periods.
  bool has_reached(double time_s) const noexcept;
  /// Likewise since 0 s.
  bool has_come_to(double time_s) const noexcept;

  /// `duration_s` of the sim_node; 0 when the file says none [s].
  double duration_s() const noexcept { return duration_s_; }
  /// What is worth a word about the files, but no error.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  sim::Simulation& simulation() noexcept { return loaded_->simulation; }
  const engine::World& world() const noexcept { return loaded_->simulation.world(); }
  const scene::Scene& scene() const noexcept { return loaded_->simulation.scene(); }
  double time_s() const noexcept { return loaded_->simulation.simulated_s(); }
  /// 0, or the time of the saved state that the scene began from [s].
  double start_s() const noexcept { return loaded_->simulation.start_s(); }

  /// True if a device plays this port; its driver.
  bool plays(const scene::Port& port) const noexcept;
  std::string driver_of(const scene::Port& port) const;
  /// What the port was given in the last tick: its position [m], or the force on it [N].
  engine::Vec3 device_value(const scene::Port& port) const;
  /// The number that its device gave for one of the axes of the port, 0 when none plays it.
  double device_value_on_axis(const scene::Port& port, std::size_t axis) const noexcept;
  /// The number that its device was answered for one of the axes of the port, 0 when none plays it.
  double answer_on_axis(const scene::Port& port, std::size_t axis) const noexcept;

  /// What leads the hand of a device with the driver `pointer`; null for all others. Its keys are
  /// free unless the caller leads it.
  device::PointerPort* pointer_port(const std::string& name) noexcept;

  /// The changes of state of the last tick; how many there was no room for.
  std::span<const engine::LinkEvent> events() const noexcept { return events_.events(); }
  std::uint64_t lost_events() const noexcept { return events_.lost(); }

  /// The MATs of a name; the links of a name. @throws std::out_of_range for a name there is not.
  scene::NamedRange mats(const std::string& name) const;
  scene::NamedRange links(const std::string& name) const;
  engine::Vec3 position(const std::string& name, std::uint32_t index = 0) const;
  engine::Vec3 velocity(const std::string& name, std::uint32_t index = 0) const;

  /// The scene as it is now, as sim_node publishes it: its description and its frame.
  msg::SceneDescription description() const;
  msg::SceneFrame frame();

  /// A signal of the scene, as it was after the last tick. @throws std::out_of_range likewise.
  double signal(const std::string& name) const;
  /// All of them, in their order.
  const std::vector<double>& signals() const noexcept { return row_; }

  /// Why the devices were let go of, or that the scene is beyond its certificate; empty if neither.
  std::string bound_text() const;

  /// integration_error_text() of the first frame in which the steps had made or taken so much, with
  /// its time; empty if none.
  const std::string& integration_error_text() const noexcept { return integration_error_text_; }

  /// The energy now; Energy::largest is that of all frames.
  engine::Energy energy() const;
  /// What the energy account does not explain, relative to the largest of its entries.
  double energy_residual() const;

 private:
  class SimulatedDevice;
  const SimulatedDevice* device_of(const scene::Port& port) const noexcept;
  /// True if a time is not above so many gesture periods.
  bool periods_are_over(double time_s, std::uint64_t count) const noexcept;
  void load_launch(const std::string& file, const std::vector<std::string>& overrides);
  void load_scene(const std::string& file);
  void warn(const config::Problems& problems);
  void watch_integration_error(const engine::Energy& energy);

  std::unique_ptr<sim::LoadedScene> loaded_;
  std::vector<std::unique_ptr<SimulatedDevice>> devices_;
  std::vector<double> row_;
  std::vector<std::string> warnings_;
  std::string integration_error_text_;
  double duration_s_ = 0.0;
  std::uint64_t frame_count_ = 0;
  sim::EventRoom events_;
};

}  // namespace cordis::cli
