// sim_node/engine/matter/mat_array.h -- the matter of a world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/mat_blocks.h"
#include "sim_node/engine/matter/mat_layout.h"
#include "sim_node/engine/matter/step_kernel.h"

namespace cordis::engine {

/// The MAT that a row of padding joins to itself: another for the next row, so that none waits until
/// the one before it has added its 0.
inline std::uint32_t mat_of_padding(std::size_t row, std::size_t mat_count) noexcept {
  return static_cast<std::uint32_t>(row % mat_count);
}

/// What moving the masses by one step reports.
struct AdvanceReport {
  std::uint32_t non_finite_mats = 0;  ///< masses whose new position is not finite
  double medium_work = 0.0;           ///< taken by the viscosity of the medium in this step [J]
};

/// The MATs of a network: force in, position out.
///
///     x(n+1) = 2 x(n) - x(n-1) + (dt^2 / m) (f(n) + m g - Z (x(n) - x(n-1)) / dt),   Z of the
///     medium
///
/// Masses move by this law, fixed points never, port masses by move_port alone. Positions, delayed
/// positions, forces and carried displacements are stored as their MatLayout says; every other array
/// named here is 4 x N, column i belonging to MAT i. By axis, only `cordis` and `leapfrog` move them.
/// Source: [Luc90 III.2.1 Matter modelisation].
class MatArray {
 public:
  /// Positions of step 0; delayed positions one period at the velocity v0 before them.
  explicit MatArray(const NetworkDescription& description, const MatLayout& layout,
                    const MatBlocks& blocks);

  /// Takes the forces of step 0, computed with the delayed positions of the constructor, for a
  /// start of second order. The delayed positions become those of the half-step velocity v0 - a0 dt
  /// / 2. Clears the forces.
  void start() noexcept;

  void clear_forces(ThreadTeam& team) noexcept;
  void clear_forces(std::span<const std::uint32_t> of_mats) noexcept;

  /// Rows [first, last) of masses.
  struct Range {
    std::size_t first;
    std::size_t last;
  };
  /// From now on only these rows of masses are moved; at first all masses are.
  void move_only(std::span<const Range> rows) noexcept;
  /// What forces and gravity add to the displacement of a mass in this period [m].
  Vec3 kick_at_half_step(std::uint32_t mat) const noexcept { return kick_of(mat, force(mat)); }
  /// dt times the change of velocity that the last forces, the medium and this force from outside have
  /// made of a mass that has moved since [m].
  Vec3 velocity_increment(std::uint32_t mat, const Vec3& external_force) const noexcept;
  /// velocity_increment() of a mass that has not moved since the forces were summed [m].
  Vec3 next_velocity_increment(std::uint32_t mat, const Vec3& external_force) const noexcept;
  /// A mass stays where it is, at rest.
  void halt(std::uint32_t mat) noexcept;

  /// Moves every mass by one step. Views of the positions from before are then those of the delayed
  /// ones. Real time: O(N), no allocation.
  [[nodiscard]] AdvanceReport advance(const StepKernel& kernel, ThreadTeam& team) noexcept;

  /// Moves every mass by one step of `leapfrog`; see StepKernel::extrapolate.
  /// @param extrapolated  as the MatLayout says, x(n) - dt v(n), then that of the next step
  [[nodiscard]] AdvanceReport extrapolate(const StepKernel& kernel,
                                          AlignedVector<double>& extrapolated,
                                          ThreadTeam& team) noexcept;

  /// Changes the velocities of the masses by a part of what the forces and gravity do in a period.
  void kick(const StepKernel& kernel, double part, AlignedVector<double>& velocity) noexcept;
  /// Kicks the masses; then moves them by a part of a period at these velocities, where the delayed
  /// positions stay, and clears all forces.
  void kick_and_drift(const StepKernel& kernel, double kick, double drift,
                      AlignedVector<double>& velocity) noexcept;
  /// Moves the masses by these displacements. @return how many are not finite then
  [[nodiscard]] std::uint32_t move_by(const AlignedVector<double>& displacement) noexcept;
  /// Puts a mass of a network in 1 dimension somewhere.
  void set_motion(std::uint32_t mat, double position, double delayed) noexcept {
    position_[layout_.offset(mat)] = position;
    delayed_[layout_.offset(mat)] = delayed;
  }
  /// The delayed positions become the present ones, and those of the masses a period at these
  /// velocities before them. @return how many positions are not finite
  void delay() noexcept { delayed_ = position_; }
  [[nodiscard]] std::uint32_t delay_by(const StepKernel& kernel,
                                       const AlignedVector<double>& velocity) noexcept;
  /// x(n) - x(n-1) of the masses and ports, 4 x N [m].
  void find_displacements(AlignedVector<double>& displacement) const noexcept;
  /// dt^2 times the forces and weights of the masses, and what the medium takes of these
  /// displacements, 4 x N [kg m]. @return half of what it takes in a period [J]
  double find_kick_in_medium(const AlignedVector<double>& displacement,
                             AlignedVector<double>& kick) const noexcept;
  /// What a force and gravity add to the way of a mass in a period [m].
  Vec3 kick_of(std::uint32_t mat, const Vec3& force) const noexcept {
    return dt2_over_mass_[mat] * force + weight_step(mat);
  }
  /// What the medium does to a mass at x(n) - dt v(n) [N].
  Vec3 force_of_medium(std::uint32_t mat, const Vec3& extrapolated) const noexcept {
    return viscosity_over_dt(mat) * (extrapolated - position(mat));
  }
  /// Adds to the forces on all MATs, 4 x N.
  void add_forces(const AlignedVector<double>& more) noexcept;

  /// Puts the delayed position of a port somewhere, before step 0.
  void set_delayed(std::uint32_t mat, const Vec3& position) noexcept;
  /// Moves a MAT from where it is, its delayed position then.
  void move_port(std::uint32_t mat, const Vec3& position) noexcept;

  std::size_t count() const noexcept { return dt2_over_mass_.size(); }
  bool is_mass(std::uint32_t mat) const noexcept { return dt2_over_mass_[mat] > 0.0; }
  const MatLayout& layout() const noexcept { return layout_; }
  /// x(n), 4 x N, by axis as of the last update_columns() [m].
  Columns position() const noexcept {
    return {layout_.is_by_axis() ? columns_.data() : position_.data(), 4,
            static_cast<Eigen::Index>(count())};
  }
  /// Brings position() to x(n). Real time: O(N) by axis, else nothing.
  void update_columns() noexcept;

  Vec3 position(std::uint32_t mat) const noexcept { return vector(position_, mat); }
  Vec3 delayed(std::uint32_t mat) const noexcept { return vector(delayed_, mat); }
  Vec3 force(std::uint32_t mat) const noexcept { return vector(force_, mat); }
  /// x(n) - x(n-1) [m]; of `cordis` and `leapfrog` as it is carried, before it was rounded.
  Vec3 moved(std::uint32_t mat) const noexcept {
    return moved_.empty() || !is_mass(mat) ? Vec3(position(mat) - delayed(mat))
                                           : vector(moved_, mat);
  }
  /// x(n-1) of a mass, or of a MAT that a Drive moves along with the masses; of all else, which rests
  /// between two steps, x(n). [m]
  Vec3 delayed_at_rest(std::uint32_t mat) const noexcept {
    return vector(is_mass(mat) || is_driven(mat) ? delayed_ : position_, mat);
  }
  bool is_driven(std::uint32_t mat) const noexcept { return !driven_.empty() && driven_[mat] != 0; }
  /// Where a MAT was when the last forces were computed [m].
  Vec3 position_of_forces(std::uint32_t mat) const noexcept {
    return forces_are_present_ ? position(mat) : delayed_at_rest(mat);
  }
  /// Says that the last forces were computed at x(n), not at x(n-1) as by moving since.
  void set_forces_are_present(bool present) noexcept { forces_are_present_ = present; }
  void set_force(std::uint32_t mat, const Vec3& force) noexcept;

  /// Where the links find the positions and leave their forces.
  ForceColumns force_columns() noexcept;

  /// x(n), x(n-1), f(n), and the carried displacements.
  void serialize(Archive& archive);

 private:
  MassColumns columns(double* extrapolated) noexcept;
  void choose_rows(MassColumns& columns, const Range& range) const noexcept;
  std::size_t moving_from(std::uint32_t mat) const noexcept;
  template <class Use>
  void share_blocks(ThreadTeam& team, const Use& use) const noexcept;
  void list_by_weight(std::span<const Range> rows, std::vector<Range>& listed) const noexcept;
  bool are_alike(std::size_t a, std::size_t b) const noexcept;
  /// Z of the medium on a mass over dt [N/m].
  double viscosity_over_dt(std::size_t mat) const noexcept {
    return own_viscosity_over_dt_.empty() ? medium_viscosity_over_dt_ : own_viscosity_over_dt_[mat];
  }
  Vec3 weight_step(std::size_t mat) const noexcept {
    return !weightless_.empty() && weightless_[mat] != 0 ? Vec3(Vec3::Zero()) : weight_step_;
  }
  AdvanceReport advance_rows(Advance advance_row, double* extrapolated, double share,
                             ThreadTeam& team, bool& all_finite) noexcept;
  Vec3 vector(const AlignedVector<double>& values, std::uint32_t mat) const noexcept {
    return layout_.vector(values.data(), mat);
  }
  void set(AlignedVector<double>& values, std::size_t mat, const Vec3& vector) noexcept {
    layout_.set_vector(values.data(), mat, vector);
  }
  std::uint32_t count_non_finite() const noexcept;

  MatLayout layout_;
  MatBlocks blocks_;
  std::size_t dimension_;
  AlignedVector<double> position_;
  AlignedVector<double> delayed_;
  AlignedVector<double> force_;
  AlignedVector<double> moved_;                // of masses [m]; empty unless `cordis` or `leapfrog`
  AlignedVector<double> columns_;              // x(n) for position() [m]; empty unless by axis
  AlignedVector<double> dt2_over_mass_;        // [s^2/kg], 0 unless a mass
  AlignedVector<double> velocity_retention_;   // 1 - dt Z / m
  std::vector<double> mass_;                   // [kg], 0 unless a mass
  std::vector<std::uint8_t> weightless_;       // by MAT; empty: none, or no gravity
  std::vector<std::uint8_t> driven_;           // by MAT; empty: none has a driven position
  std::vector<Range> masses_;                  // rows of neighbours of one weight, medium and block
  std::vector<Range> moving_;                  // those that are moved
  std::vector<AdvanceResult> advanced_;        // of each of these in this step
  std::vector<std::uint32_t> ports_;           // MATs that move_port() moves
  double dt_;                                  // [s]
  Vec3 weight_step_;                           // gravity * dt^2 [m]
  double medium_viscosity_over_dt_;            // Z / dt [N/m]
  std::vector<double> own_viscosity_over_dt_;  // by MAT; empty: all have that of the network
  bool in_medium_;                             // something is taken by it
  bool forces_are_present_ = false;
};

}  // namespace cordis::engine
