// sim_node/run/simulation.h -- one scene in motion, tick by tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim_node/checks/pair_watch.h"
#include "sim_node/checks/partner_watch.h"
#include "sim_node/devices/device_exchange.h"
#include "sim_node/engine/world.h"
#include "sim_node/run/event_room.h"
#include "sim_node/run/kinetic_watch.h"
#include "sim_node/run/step_rows.h"
#include "sim_node/run/tick_division.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What went wrong in the steps so far.
struct StepTroubles {
  std::uint64_t overflowed_steps = 0;  ///< steps with StepReport::overflowed_sets
  std::uint64_t forgotten_pairs = 0;   ///< sum of StepReport::forgotten_pairs
  /// Sum of StepReport::refused_inputs, refused_drives and refused_parameters.
  std::uint64_t refused_inputs = 0;
  std::uint64_t refused_drives = 0;        ///< sum of StepReport::refused_drives
  std::uint64_t refused_parameters = 0;    ///< sum of StepReport::refused_parameters
  double first_refused_parameter_s = 0.0;  ///< simulated time of the first
  std::uint64_t drive_jumps = 0;           ///< sum of StepReport::drive_jumps
  double first_jump_s = 0.0;               ///< simulated time of the first
};

/// What the drives of a scene have done wrong, for a person; empty when nothing.
std::string drive_trouble_text(const StepTroubles& troubles);

/// What the formulas of liaisons have done wrong, for a person; empty when nothing.
std::string parameter_trouble_text(const StepTroubles& troubles);

/// What else went wrong in the steps, each with its number, for a person; none when nothing.
std::vector<std::string> step_trouble_texts(const StepTroubles& troubles);

/// What a scene has passed beyond which its step is not certain to be stable.
enum class PassedBound : std::uint8_t { kNone, kPartners, kNumber, kEnergy };

/// A scene, its world and the exchanges with its devices. A tick is one gesture period: the steps of
/// the world between a sample of the devices and the answer to it, as TickDivision counts them.
/// [Luc90 V.1 Force feedback gestual transducers] Nothing here knows of DDS, threads or clocks.
class Simulation {
 public:
  /// Precondition: a saved state of the scene ends with a tick, as read_start_state() sees to.
  /// @param epoch  of this sim_node
  Simulation(std::shared_ptr<const scene::Scene> scene, std::uint64_t epoch);

  /// Goes on where a simulation of the same scene with other parameters is.
  /// @param room  as World::take_over() wants it
  /// @return false when the scenes do not fit; then nothing has changed. Real time as take_over().
  bool go_on_from(const Simulation& before, std::vector<double>& room) noexcept;

  /// Does the next steps of a tick, at most so many. Real time: does not throw, and allocates
  /// nothing but room for more bonds, between two steps.
  /// Does nothing once failed(). @param events  where the changes of state go
  /// @param rows  where the signals of each step go; may be null
  /// @return whether the tick is complete.
  bool advance(int steps, EventRoom& events, StepRows* rows = nullptr) noexcept;

  /// @param row  room for one value per signal of the scene
  void read_signals(double* row) const noexcept { scene_->signals.read(world_, row); }

  /// The exchange of a device, nullptr when no port of the scene is its.
  DeviceExchange* find(std::uint32_t device_id) noexcept;
  std::vector<DeviceExchange>& devices() noexcept { return devices_; }
  bool has_devices() const noexcept { return !devices_.empty(); }
  /// Time of the newest sample of all devices that are there; 0 when none is [ns].
  std::int64_t action_time_nsec() const noexcept;

  /// True if a device has fallen silent that was there: DeviceExchange::is_missed().
  bool misses_a_device() const noexcept;

  const scene::Scene& scene() const noexcept { return *scene_; }
  const std::shared_ptr<const scene::Scene>& shared_scene() const noexcept { return scene_; }
  const engine::World& world() const noexcept { return world_; }
  engine::World& world() noexcept { return world_; }
  /// Steps of the present tick; between two ticks of the next one.
  int steps_of_tick() const noexcept { return division_.steps(); }
  /// Steps that the present tick still wants; steps_of_tick() between two ticks.
  int steps_left_in_tick() const noexcept { return division_.steps() - steps_in_tick_; }
  const TickDivision& division() const noexcept { return division_; }
  bool is_between_ticks() const noexcept { return steps_in_tick_ == 0; }
  std::uint64_t tick_count() const noexcept { return tick_count_; }
  /// Ticks that were over in the state it began from.
  std::uint64_t start_tick_count() const noexcept { return start_tick_count_; }
  double simulated_s() const noexcept;
  /// 0, or the time of the state it began from.
  double start_s() const noexcept { return start_s_; }
  /// True if the saved state of the scene does not fit its parameters: it begins at 0 s then.
  bool misses_start_state() const noexcept;

  /// How many others a mass of a set has touched, over all steps.
  const PartnerWatch& partners() const noexcept { return partners_; }

  /// Seen between the steps, with the rate of a KineticWatch [J].
  double largest_kinetic_energy() const noexcept { return kinetic_.largest(); }

  const StepTroubles& troubles() const noexcept { return troubles_; }

  /// From now on no bound lets go of the devices.
  void keep_devices() noexcept { keeps_devices_ = true; }
  /// Lets go of all devices until the scene restarts or another one is loaded: they feel no force,
  /// and their MATs hold still. The first reason stays. Partners beyond what is certified do so in
  /// the step in which they come, and two members of a set before they meet too hard for the step. Does nothing after keep_devices().
  void let_devices_go(PassedBound bound) noexcept;
  /// Why the devices were let go of.
  PassedBound passed_bound() const noexcept { return passed_bound_; }

  /// The scene diverged: a position or the energy is no longer finite. Its forces must not be used
  /// any more.
  bool failed() const noexcept { return failed_; }
  /// The energy of the world is no finite number: it has diverged.
  void fail() noexcept { failed_ = true; }
  /// Which MAT left the finite numbers first, or is the fastest; when, and which liaison is to blame.
  /// Empty while nothing failed. Not in real time.
  std::string failure() const;

 private:
  std::shared_ptr<const scene::Scene> scene_;
  engine::World world_;
  PartnerWatch partners_;
  PairWatch pairs_;
  KineticWatch kinetic_;
  StepTroubles troubles_;
  std::vector<DeviceExchange> devices_;
  TickDivision division_;
  int steps_in_tick_ = 0;  // done in the present tick
  std::uint64_t tick_count_ = 0;
  std::uint64_t start_tick_count_ = 0;
  double start_s_ = 0.0;
  bool failed_ = false;
  PassedBound passed_bound_ = PassedBound::kNone;
  bool keeps_devices_ = false;
};

}  // namespace cordis::sim
