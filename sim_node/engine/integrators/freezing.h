// sim_node/engine/integrators/freezing.h -- regions at rest are left out of a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/matter/port_inputs.h"

namespace cordis::engine {

struct WorldState;

/// Stops masses that rest, and leaves out what joins them, until something moves them: the paper's
/// local area of deformation.
///
/// A mass falls asleep when all of this holds in every step of a window of time:
///
/// - It stays within e of one point.
/// - It is so slow that its dampers pull less than F.
/// - The sum of all forces on it is below F = e K.
///
/// e is a quarter of the tolerance. K is the stiffness of the mass: the sum of that of its linear
/// links or, if it has none, the least of the laws that may act on it. A mass without stiffness
/// never sleeps, nor does one of whose weight more than a tenth is not carried, or on which a force
/// from outside is held. It is stopped where it is; the energy it had counts as dissipated, exactly.
///
/// A sleeper wakes in the step in which the sum of all forces on it exceeds F, a link at it changes
/// its state, or something from outside touches it. Forces are computed of each liaison at a mass
/// that is awake, or beside one, with the same bits as without freezing. So nothing that is awake
/// knows of it, and the condition to wake is tested on whole forces. Fixed points are beside
/// nothing: what sleepers put on them is not summed. A port and a MAT that is kept awake never
/// sleep.
///
/// Forces below F on many masses move a soft or free structure far. So sleepers are tried: they
/// wake together after a pause and do what they would do if they were free. Who stays within e
/// sleeps again, and the next pause and window are twice as long, up to kMaxLevel. So a trial finds
/// a creep of e in a window, and costs a part of the time that goes to 1/kPausesPerWindow.
///
/// Between sleepers nothing is computed but Maxwell elements, whose forces fade, and links and sets
/// with conditions on an age or an impulse. All other conditions are tested after the last of their
/// ends has stopped, and cannot change after that.
class Freezing {
 public:
  static constexpr std::uint64_t kPausesPerWindow = 16;
  static constexpr std::uint8_t kMaxLevel = 10;

  explicit Freezing(const NetworkDescription& network);

  /// Takes the stiffnesses of other state machines, and wakes all.
  void adopt(const NetworkDescription& network, const std::vector<StateMachine>& state_machines);

  void wake(std::uint32_t mat) noexcept;
  void wake_all() noexcept;
  /// True if a force from outside is held on a mass: it does not sleep then.
  void hold(std::uint32_t mat, bool is_held) noexcept { held_[mat] = is_held; }

  bool is_asleep(std::uint32_t mat) const noexcept { return asleep_[mat] > 0; }
  std::uint32_t asleep_count() const noexcept { return asleep_count_; }

  /// Before the forces of a step: chooses the liaisons that are computed, where those that are
  /// awake have changed, and clears the forces they add to. Real time: O(MATs + liaisons), no
  /// allocation. @param sets_changed  other pairs may be in range
  void choose_liaisons(WorldState& world, bool sets_changed) noexcept;
  /// After them: forces on sleepers of which not all were computed are what they were.
  void restore_forces(MatArray& mats) const noexcept;

  /// After all forces of a step, before it moves: who wakes, and who falls asleep.
  /// @param at_moments  whether the account belongs to the moments x(n), or the middles between
  /// @return the energy of those that are stopped [J]. Real time: O(MATs with whole forces), no
  ///         allocation.
  [[nodiscard]] double choose_movers(WorldState& world, bool at_moments) noexcept;
  /// The masses that choose_movers has stopped.
  std::span<const std::uint32_t> stopped() const noexcept { return stopped_; }

  void serialize(Archive& archive);
  /// After it has been restored. @param port_inputs  of the same state
  void restored(const PortInputs& port_inputs) noexcept;

 private:
  /// Asleep, and its liaisons have been computed with it at rest: what their conditions remember of
  /// the steps before, a tension and whether it rises, is that of rest then.
  static constexpr std::uint8_t kLeftOut = 4;

  bool is_balanced(const MatArray& mats, std::uint32_t mat) const noexcept;
  auto anchor(std::uint32_t mat) noexcept { return Vec3::Map(&anchor_[3 * std::size_t{mat}]); }
  bool is_quiet(const MatArray& mats, std::uint32_t mat) noexcept;
  std::uint64_t window_of(std::uint32_t mat) const noexcept;
  void wake_at_its_level(std::uint32_t mat) noexcept;
  void try_sleepers(std::uint64_t step) noexcept;
  double stop(MatArray& mats, std::uint32_t mat, bool at_moments) noexcept;
  void wake_where_states_change(const WorldState& world) noexcept;
  void choose_roles(WorldState& world) noexcept;
  void list_mats(const MatArray& mats) noexcept;
  void list_movers(MatArray& mats) noexcept;

  std::vector<double> max_kick_;       // square of the largest kick_at_half_step at rest; < 0: none
                                       // [m^2]
  std::vector<double> max_moved_;      // square of the largest displacement in a step at rest [m^2]
  std::vector<double> mass_over_dt2_;  // [kg/s^2]; 0 unless a mass
  double max_drift_ = 0.0;             // square of e [m^2]
  std::uint64_t first_window_;         // [steps]
  std::vector<std::uint32_t> quiet_;   // of a mass that is awake: steps at rest in a row
  std::vector<std::uint8_t> asleep_;   // of a sleeper: steps asleep, up to kLeftOut; 0: awake
  std::vector<std::uint8_t> level_;    // trials since something else woke it
  std::vector<double> anchor_;         // where it has been since it is quiet, 3 values each [m]
  std::vector<bool> held_;
  std::vector<bool> kept_awake_;
  std::vector<bool> never_rests_;  // by state machine
  MatRoles roles_;
  std::vector<std::uint32_t> whole_;     // masses with whole forces, ascending
  std::vector<std::uint32_t> computed_;  // MATs that forces are added to
  std::vector<std::uint32_t> some_;      // sleepers among them with some forces
  std::vector<double> force_;            // of some_, whole: 3 values each
  std::vector<MatArray::Range> movers_;
  std::vector<std::uint32_t> stopped_;
  std::uint32_t asleep_count_ = 0;
  bool woken_ = true;    // other liaisons must be computed in the next step
  bool changed_ = true;  // others may be left out
  bool movers_changed_ = true;
};

}  // namespace cordis::engine
