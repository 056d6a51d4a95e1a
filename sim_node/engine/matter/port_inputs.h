// sim_node/engine/matter/port_inputs.h -- what a world takes from outside: positions of its ports,
// forces on its masses, and what its drives say of both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// The two halves of the dual dipole: a port mass is given positions and its links answer with a
/// force; a mass is given forces and answers with a position. A drive gives them as a function of time
/// instead: its ports move along with the masses, at the end of a step. Keeps the work they do. [Luc90 V.
/// Outside communication]
class PortInputs {
 public:
  explicit PortInputs(const NetworkDescription& description);

  /// The position a port mass takes at the beginning of the next step [m]. Real time: O(1), no
  /// allocation.
  void impose_position(std::uint32_t mat, const Vec3& position) noexcept;
  /// The force [N] held on a mass from the next step on. Real time: O(1), no allocation.
  void hold_force(std::uint32_t mat, const Vec3& force) noexcept;
  /// The force held on a mass [N], with that of a drive in the last step, at first in the coming one; 0
  /// for a port.
  Vec3 external_force(std::uint32_t mat) const noexcept;
  /// How many positions and forces were not finite since this was last asked.
  [[nodiscard]] std::uint32_t take_refused() noexcept;
  /// How many values of drives were not finite, and how many positions jumped, since this was last asked.
  [[nodiscard]] std::uint32_t take_refused_drives() noexcept;
  [[nodiscard]] std::uint32_t take_drive_jumps() noexcept;

  /// Puts the delayed positions of driven ports where the way of the first period begins: before anything
  /// is done with the MATs.
  void begin(MatArray& mats) noexcept;
  /// The masses whose driven forces ask for their place or velocity, ascending.
  std::size_t placed_count() const noexcept { return placed_forces_.size(); }
  std::uint32_t placed_mat(std::size_t index) const noexcept {
    return driven_forces_[placed_forces_[index]].mat;
  }
  /// Where such a mass is [m], and how fast [m/s], for find_driven_forces(). Real time: O(1).
  void set_motion(std::size_t index, const Vec3& position, const Vec3& velocity) noexcept {
    driven_forces_[placed_forces_[index]].position = position;
    driven_forces_[placed_forces_[index]].velocity = velocity;
  }
  /// The forces that drives put on masses in a step. Real time: O(drives), no allocation.
  /// @param variables  values of those of the network; may be null where none is asked for
  void find_driven_forces(std::uint64_t step, const double* variables) noexcept;
  /// Where a driven port is at a step [m]; perhaps no finite numbers. Real time: as of value_at().
  Vec3 driven_place(std::uint32_t mat, std::uint64_t step) const noexcept;
  /// Moves the driven ports to a step, after the masses. @return half of the work [J] they do over the new
  /// period. Real time: O(drives), no allocation.
  [[nodiscard]] double drive_to(std::uint64_t step, MatArray& mats) noexcept;

  /// The forces of the links before step 0, which the account of the ports begins with.
  void start(const MatArray& mats) noexcept;

  /// The masses that a force is held on.
  std::size_t held_count() const noexcept { return forces_.size(); }
  /// Holds no forces any more. Real time: O(held forces), no allocation.
  void let_go() noexcept;
  std::uint32_t held_mat(std::size_t index) const noexcept { return forces_[index].mat; }
  /// The port masses, in their order.
  const std::vector<std::uint32_t>& ports() const noexcept { return port_mats_; }

  /// Moves the ports that nothing drives. @return work [J] the last forces of their links took from the outside on the
  /// way, half of it.
  [[nodiscard]] double move_ports(MatArray& mats) noexcept;
  /// @param at_start  nothing has been driven yet
  /// @return the other half, with the forces of the links at the new positions.
  [[nodiscard]] double work_at_ports(const MatArray& mats, bool at_start = false) noexcept;

  /// Adds the held forces to those of the links. @return half of their work [J] over the last
  /// period.
  double kick(MatArray& mats) noexcept;
  /// Takes them away again after the masses have moved. @return half of their work [J] over the new
  /// period.
  [[nodiscard]] double release(MatArray& mats) const noexcept;

  /// Its length depends on the number of held forces.
  void serialize(Archive& archive);

 private:
  struct Port {
    std::uint32_t mat;
    Vec3 next;                       // position at the beginning of the next step [m]
    Vec3 link_force = Vec3::Zero();  // of the last step [N]
    const Drive* drive = nullptr;    // of the network; none: moved from outside
  };
  struct DrivenForce {
    std::uint32_t mat;
    std::span<const Drive> drives;   // of the network, whose forces add up
    Vec3 position = Vec3::Zero();    // of set_motion() [m]
    Vec3 velocity = Vec3::Zero();    // likewise [m/s]
    Vec3 force = Vec3::Zero();       // [N]
    Vec3 link_force = Vec3::Zero();  // as of HeldForce
  };
  struct HeldForce {
    std::uint32_t mat;
    Vec3 force;                      // [N]
    Vec3 link_force = Vec3::Zero();  // of the links alone, while the step adds both [N]
  };

  Vec3 within_dimension(Vec3 value) const noexcept;
  bool is_port(std::uint32_t mat) const noexcept;

  double time_of(std::uint64_t step) const noexcept {
    return static_cast<double>(step) * network_.step;
  }
  void find_values(const std::vector<std::uint32_t>& functions, std::uint64_t step) noexcept;
  const DrivenForce* driven_force_on(std::uint32_t mat) const noexcept;
  Vec3 force_of(const Drive& drive, const FunctionPoint& point) const noexcept;

  const NetworkDescription& network_;
  int dimension_;
  std::vector<bool> is_mass_;             // by MAT
  std::vector<Port> ports_;               // in MAT order
  std::vector<std::uint32_t> port_mats_;  // of ports_
  std::vector<HeldForce> forces_;    // in the order in which the masses were first given one; room
                                     // for all masses
  std::vector<std::uint32_t> slot_;  // by MAT: its place in ports_ or forces_
  std::vector<DrivenForce> driven_forces_;  // in MAT order
  std::uint32_t refused_ = 0;
  std::vector<std::uint32_t> moving_functions_;  // of driven ports, each once
  std::vector<std::uint32_t> force_functions_;   // of driven_forces_ that are of time, each once
  std::vector<bool> is_of_time_;                 // by function of the network
  std::vector<std::uint32_t> placed_forces_;     // of driven_forces_ that ask for place or velocity
  std::vector<Vec3> function_value_;             // of the network's, at the step of the last call
  std::uint32_t refused_drives_ = 0;
  std::uint32_t drive_jumps_ = 0;
};

}  // namespace cordis::engine
