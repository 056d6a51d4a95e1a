// sim_node/engine/integrators/implicit_damping.h -- linear dampers and medium, solved implicitly.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/integrators/stiffness_matrix.h"
#include "sim_node/engine/matter/mat_array.h"
#include "sim_node/engine/matter/port_inputs.h"

namespace cordis::engine {

/// One period of the velocities under linear dampers and the medium, Z, and under all other forces
/// f. The scheme is SDIRK2 from n-1/2 to n+1/2 with g = 1 - 1/sqrt(2), of second order and
/// L-stable; Z is that of the positions x(n):
///
///     (M + g dt Z) u1 = M v + g dt f1,                              f1 = f(n) + (g - 1/2) df
///     (M + g dt Z) u2 = M v + (1-g)/g M (u1 - v) + g dt f2,         f2 = f(n) + df / 2
///     w = (1-g) u1 + g u2,     v(n+1/2) = v + dt M^-1 (f(n) - Z w),  df = f(n) - f(n-1)
///
/// w is the velocity of the moment x(n). The dampers act as pairs of opposite forces, so momentum
/// and angular momentum are kept to rounding; the rounding of a velocity grows with Z dt / m.
/// Stable while dt^2 K < 3.852 M, however large Z is (implicit_damping_limit).
///
/// Ports move as given: with v(n) + c dv at the moment n + c, where c is g - 1/2 for u1 and 1/2 for u2. Of a
/// driven one the next place is known. So dv is the change from v(n-1/2) to v(n+1/2), and v(n) their mean. Of
/// any other one dv is 0, and v(n) that of the last period.
///
/// A damper pulls along its axis a at x(n), and turns meanwhile. At the moment n + c its ends part by a u + c k:
/// c is g - 1/2 for u1 and 1/2 for u2. Ends that keep their length part by -k / 2 along, from what u2 goes
/// across. At first k is found from v and the kicks. Where a damper turns by more than 0.01 rad, u2 is solved again
/// with the k of the first u2. Kicks that other dampers take away make the first k much too large. Where it is more
/// than twice that of u2, and off by more than 0.001 of how much longer the damper becomes, u1 is solved again as well.
/// So a heavy damper that turns keeps its length, and what hangs on several creeps as it should.
///
/// The first period goes from x(0) to x(1): it begins with v(0), and v(1/2) is its mean velocity v_m. Dampers
/// take from x(0) to the moment 1/2, with the damping force I / dt and A = (M + g dt Z)^-1 M,
///
///     (v(0) + v_m) I / 2 + dt (v_m - v(0)) (f - M A^2 M^-1 f) / 4,     I = dt f / 2 - M (v_m - v(0))
///
/// The second term counts a creep that begins at once, whose elastic work is f v_m dt / 2. It is exact for heavy
/// dampers and 0 without any, for decay and for creep that lasts. Forces l that store no energy, of which f is without
/// here, take -l (v(0) + v_m) dt / 4.
/// All vectors are dt times a velocity, or dt^2 times an acceleration [m], 4 x N.
/// Source: Alexander, Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s, 1977.
class ImplicitDamping {
 public:
  explicit ImplicitDamping(const NetworkDescription& network);

  /// Takes Z at the present positions; no force is constant over the period yet.
  /// @param displacement  dt v(n-1/2); before the first period dt v(0); of a port its last one
  /// @param extrapolated  of ports x(n) - dt v(n), stored as the MATs are [m]
  /// @param last_kick     kick() of the last step, which stays until the next; null: not known, and
  ///                      the forces change little
  /// @param first         this is the period from x(0)
  /// Real time: in 2 and 3 dimensions one numeric factorisation, no allocation.
  void begin_step(const MatArray& mats, const AlignedVector<double>& displacement,
                  const AlignedVector<double>& extrapolated, const double* last_kick,
                  bool first) noexcept;

  /// Counts `force` [N] at `mat`, which is among the forces of the MATs, as constant over the
  /// period.
  void add_constant_force(std::uint32_t mat, const Vec3& force) noexcept;

  /// Finds dt w under the forces of the MATs.
  /// @param external  forces from outside to be added to them; null: they have been
  /// Real time: two solves, three or four where dampers turn fast; no allocation.
  void find_velocities(const MatArray& mats, const PortInputs* external) noexcept;
  /// dt^2 (f(n) / m + g) of the masses, without what is constant over the period.
  const AlignedVector<double>& kick() const noexcept { return kick_; }
  /// The component of dt w at b less that at a [m].
  double elongation(std::uint32_t a, std::uint32_t b, const Vec3& axis) const noexcept;
  /// The component of dt v(n-1/2) at b less that at a [m].
  double elongation_before(std::uint32_t a, std::uint32_t b, const Vec3& axis) const noexcept;
  /// Finds how dt w answers to a constant force of 1 N that pulls a and b together along the axis.
  /// @return how much shorter elongation() becomes [m/N], > 0
  /// Real time: two solves, no allocation.
  double find_response(std::uint32_t a, std::uint32_t b, const Vec3& axis) noexcept;
  /// Adds the last response, times a force [N], to dt w.
  void add_response(double force) noexcept;

  /// What a period has done.
  struct Work {
    double dissipated = 0.0;  ///< by the dampers and the medium [J]
    double port_work = 0.0;   ///< brought in by ports through the dampers [J]
    double kinetic = 0.0;     ///< energy at the moment x(n): mean of the half steps around it [J]
    std::uint32_t non_finite_mats = 0;
  };
  /// Ends the period: moves the masses to x(n+1).
  /// @param extrapolated   becomes x(n+1) - dt v(n+1), stored as the MATs are
  /// @param losses  forces of others on each MAT that store no energy, 4 x N [N]; empty: there are none. The account has what they take at
  ///                the extrapolated velocity, and Work::dissipated the rest up to what they take on the way.
  /// Real time: O(MATs + dampers), no allocation.
  Work advance(MatArray& mats, AlignedVector<double>& extrapolated,
               const AlignedVector<double>& losses) noexcept;

  /// Forces of the linear dampers on each MAT in the last period [N], 4 x N.
  const AlignedVector<double>& force() const noexcept { return force_; }

 private:
  struct Damper {
    std::uint32_t a;
    std::uint32_t b;
    double viscosity;  // dt Z [kg]
    bool isotropic;
    Vec3 axis = Vec3::UnitX();
    double length = 0.0;   // [m]
    double turning = 0.0;  // k [m]
  };

  /// How near the guessed k of the dampers were to those of u2.
  enum class Guess : std::uint8_t {
    kRight,
    kRough,  ///< or a damper turns fast: u2 needs another
    kWrong   ///< u1 needs another, too
  };

  /// How a port moves in this period.
  struct Port {
    std::uint32_t mat;
    Vec3 centred = Vec3::Zero();  // dt v(n) [m]
    Vec3 change = Vec3::Zero();   // dt (v(n+1/2) - v(n-1/2)) [m]

    /// dt v(n + ahead) [m].
    Vec3 displacement(double ahead) const noexcept { return centred + ahead * change; }
  };

  void find_axes(const MatArray& mats) noexcept;
  void find_drag_of_ports(double ahead, AlignedVector<double>& drag) noexcept;
  /// From the moment of x(n), in periods.
  double begin_of_period() const noexcept { return first_period_ ? 0.0 : -0.5; }
  Guess find_turning(const AlignedVector<double>& displacement,
                     AlignedVector<double>& turning) noexcept;
  /// Finds u1, or u2, with the present k.
  /// @param kick_at  dt^2 (f / m + g) of a mass at a moment, in periods from that of x(n) on
  template <class KickAt>
  void solve_first(const KickAt& kick_at) noexcept;
  template <class KickAt>
  void solve_second(const KickAt& kick_at) noexcept;
  void find_carried_forces(const MatArray& mats, const AlignedVector<double>& losses) noexcept;
  void add_drag_of_links(const AlignedVector<double>& displacement,
                         AlignedVector<double>& drag) const noexcept;

  bool is_1d_;
  double dt_;
  std::vector<Damper> dampers_;
  std::vector<double> mass_;              // [kg], 0 unless a mass
  std::vector<double> medium_viscosity_;  // dt Z of the medium, per MAT [kg]
  std::vector<Port> ports_;               // that move
  StiffnessMatrix matrix_;                // M + g dt Z
  AlignedVector<double> displacement_;    // dt v(n-1/2)
  AlignedVector<double> drag_at_first_;   // g dt Z of what ports do at u1, on the masses [kg m]
  AlignedVector<double> drag_at_end_;     // likewise at u2
  AlignedVector<double> turning_;  // dt Z k of dampers along their axes, on the masses [kg m]
  AlignedVector<double> turning_at_end_;  // likewise at u2
  AlignedVector<double> constant_;        // forces [N]
  AlignedVector<double> kick_;
  const double* last_kick_ = nullptr;
  bool first_period_ = false;
  AlignedVector<double> first_;     // dt u1
  AlignedVector<double> second_;    // dt u2; after advance() dt v(n+1)
  AlignedVector<double> middle_;    // dt w
  AlignedVector<double> response_;  // also the forces that dampers carry in the first period [kg m]
  AlignedVector<double> force_;
  AlignedVector<double> drag_;  // dt Z w [kg m]
};

}  // namespace cordis::engine
