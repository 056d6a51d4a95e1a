// sim_node/engine/matter/port_inputs.h -- what a world takes from outside: positions of its ports,
// forces on its masses.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

/// The two halves of the dual dipole: a port mass is given positions and its links answer with a
/// force; a mass is given forces and answers with a position. Keeps the work they do. [Luc90 V.
/// Outside communication]
class PortInputs {
 public:
  explicit PortInputs(const NetworkDescription& description);

  /// The position a port mass takes at the beginning of the next step [m]. Real time: O(1), no
  /// allocation.
  void impose_position(std::uint32_t mat, const Vec3& position) noexcept;
  /// The force [N] held on a mass from the next step on. Real time: O(1), no allocation.
  void hold_force(std::uint32_t mat, const Vec3& force) noexcept;
  /// The force held on a mass [N]; 0 for a port.
  Vec3 external_force(std::uint32_t mat) const noexcept;
  /// How many positions and forces were not finite since this was last asked.
  [[nodiscard]] std::uint32_t take_refused() noexcept;

  /// The forces of the links before step 0, which the account of the ports begins with.
  void start(const MatArray& mats) noexcept;

  /// The masses that a force is held on.
  std::size_t held_count() const noexcept { return forces_.size(); }
  std::uint32_t held_mat(std::size_t index) const noexcept { return forces_[index].mat; }
  /// The port masses, in their order.
  const std::vector<std::uint32_t>& ports() const noexcept { return port_mats_; }

  /// Moves the ports. @return work [J] the last forces of their links took from the outside on the
  /// way, half of it.
  [[nodiscard]] double move_ports(MatArray& mats) noexcept;
  /// @return the other half, with the forces of the links at the new positions.
  [[nodiscard]] double work_at_ports(const MatArray& mats) noexcept;

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
  };
  struct HeldForce {
    std::uint32_t mat;
    Vec3 force;                      // [N]
    Vec3 link_force = Vec3::Zero();  // of the links alone, while the step adds both [N]
  };

  Vec3 within_dimension(Vec3 value) const noexcept;
  bool is_port(std::uint32_t mat) const noexcept;

  int dimension_;
  std::vector<bool> is_mass_;             // by MAT
  std::vector<Port> ports_;               // in MAT order
  std::vector<std::uint32_t> port_mats_;  // of ports_
  std::vector<HeldForce>
      forces_;  // in the order in which the masses were first given one; room for all masses
  std::vector<std::uint32_t> slot_;  // by MAT: its place in ports_ or forces_
  std::uint32_t refused_ = 0;
};

}  // namespace cordis::engine
