// cli/lab/offline_session.h -- a launch file played in one process: its scene and its devices,
// without DDS and without clocks.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device_node/exchange.h"
#include "sim_node/run/event_room.h"
#include "sim_node/run/simulation.h"
#include "sim_node/sim_config.h"

namespace cordis::cli {

/// The scene of a launch file and all its devices, with their own drivers and guards, in lockstep:
/// what a run of the processes computes, bit for bit.
class OfflineSession {
 public:
  /// A device whose driver is hardware stays away, its ports at rest.
  /// @param launch_file  its path
  /// @param overrides    as on the command line of `cordis run`
  /// @throws config::ConfigError with all problems of the files.
  explicit OfflineSession(const std::string& launch_file,
                          const std::vector<std::string>& overrides = {});
  ~OfflineSession();

  /// Plays on until so much time is simulated. @param after_tick  called once per gesture period
  /// @throws std::runtime_error when the scene diverges.
  void play_until(double time_s, const std::function<void()>& after_tick = {});

  sim::Simulation& simulation() noexcept { return *simulation_; }
  const engine::World& world() const noexcept { return simulation_->world(); }
  const scene::Scene& scene() const noexcept { return simulation_->scene(); }
  double time_s() const noexcept { return simulation_->simulated_s(); }

  /// True if a device plays this port; its driver.
  bool plays(const scene::Port& port) const noexcept;
  std::string driver_of(const scene::Port& port) const;
  /// What the port was given in the last tick: its position [m], or the force on it [N].
  engine::Vec3 given(const scene::Port& port) const;

  /// The changes of state of the last tick.
  std::span<const engine::LinkEvent> events() const noexcept { return events_.events(); }

  /// The MATs of a name; the links of a name. @throws std::out_of_range for a name there is not.
  scene::NamedRange mats(const std::string& name) const;
  scene::NamedRange links(const std::string& name) const;
  engine::Vec3 position(const std::string& name, std::uint32_t index = 0) const;
  engine::Vec3 velocity(const std::string& name, std::uint32_t index = 0) const;

  /// A signal of the scene, as it was after the last tick. @throws std::out_of_range likewise.
  double signal(const std::string& name) const;

  /// What the energy account does not explain, relative to the largest of its entries.
  double energy_residual() const;

 private:
  class Runner;
  const Runner* player_of(const scene::Port& port) const noexcept;

  std::unique_ptr<sim::Simulation> simulation_;
  std::vector<std::unique_ptr<Runner>> players_;
  std::vector<double> row_;
  sim::EventRoom events_;
};

}  // namespace cordis::cli
