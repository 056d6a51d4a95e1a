// sim_node/engine/description/network.h -- what a scene is made of, fixed once it is assembled.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/description/drive.h"
#include "sim_node/engine/description/integrator_kind.h"
#include "sim_node/engine/description/state_machine.h"
#include "sim_node/engine/description/surface.h"
#include "sim_node/engine/description/variable.h"

namespace cordis::engine {

/// What a MAT is: a punctual mass, a point that never moves, or a mass whose position is imposed
/// from outside or by a Drive.
enum class MatKind : std::uint8_t { kMass = 0, kFixed = 1, kPort = 2 };

/// One MAT of a description. [Luc90 III.2.1 Matter modelisation]
struct Mat {
  MatKind kind = MatKind::kMass;
  double mass = 0.0;             ///< [kg], > 0 for kMass, ignored otherwise
  Vec3 position = Vec3::Zero();  ///< at step 0 [m]; components beyond the dimension must be 0
  Vec3 velocity = Vec3::Zero();  ///< at step 0 [m/s]; must be 0 unless kMass
  bool weightless = false;       ///< gravity leaves it alone: something outside carries it
  double medium_viscosity = kOfNetwork;  ///< Z of the medium on it [N s/m]; below 0: of the network

  static constexpr double kOfNetwork = -1.0;
};

/// One linear LIA: spring (viscosity 0), damper (stiffness 0) or both in parallel.
/// [Luc90 III.2.2 Modelisation of the material in its continuous behaviour]
///
/// In 2 and 3 dimensions, with d the distance of the ends, along the line of centres
///
///     tension = K (d - rest) + Z (d(n) - d(n-1)) / dt
///
/// where the elongation increment is the relative displacement projected on that line; no force
/// while d is 0. In 1 dimension d is signed, d = x_b - x_a, and so is the rest length: ends may
/// cross.
///
/// An isotropic one is a vector spring: K (x_b - x_a) + Z (its elongation increment in the last period, as a
/// vector) / dt, the same in every direction and at distance 0, without a rest length. The damper
/// of another link lets one end circle the other forever; a vector spring calms it, and so keeps no angular
/// momentum. In 1 dimension there is no difference.
struct Link {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double stiffness = 0.0;    ///< K [N/m], >= 0
  double viscosity = 0.0;    ///< Z [N s/m], >= 0
  double rest_length = 0.0;  ///< [m]; >= 0 in 2 and 3 dimensions
  bool isotropic = false;    ///< then the rest length is 0
};

/// One LIA with states: between the two MATs, as its state machine says. Distance, direction and
/// elongation rate are those of Link. Any number of LIAs may stand in parallel between the same two
/// MATs.
struct StateLink {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::uint32_t state_machine = 0;  ///< index in NetworkDescription::state_machines
  double rest_length = 0.0;         ///< at step 0 [m]; any finite value
};

/// One Maxwell element, a spring and a damper in series: one internal force F and no rest length.
///
///     F(n) = a F(n-1) + Z (1 - a) (elongation increment in the last period) / dt,  a = e^(-K dt /
///     Z)
///
/// exact while the elongation rate is steady; F(0) is the start force, whatever the speed of the
/// ends. A Maxwell element and a Link in parallel are a standard linear solid.
///
/// K and Z may follow variables of the network, as those of a state machine of one state. The spring keeps its
/// elongation F / K, so that F(n-1) counts K(n) / K(n-1) times. K / Z in e^(-K dt / Z) is the mean of both
/// steps. A K that is not above 0 has no force, but the spring keeps its elongation; nor has such a Z.
struct MaxwellLink {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double stiffness = 0.0;               ///< K [N/m], > 0; 0 with a state machine
  double viscosity = 0.0;               ///< Z [N s/m], > 0; 0 with a state machine
  double start_force = 0.0;             ///< F(0) [N], any finite value; > 0 pulls the ends together
  std::uint32_t state_machine = kNone;  ///< index in NetworkDescription::state_machines, or kNone

  static constexpr std::uint32_t kNone = 0xffffffffU;
  bool follows_variables() const noexcept { return state_machine != kNone; }
};

/// One LIA of three MATs that resists bending at the middle one, b. With u from a to b, v from b to c, and
/// R the turn by the rest angle, its bend vector and its moment are
///
///     w = v / length_bc - R u / length_ab        moment = B w + Z (change of w in the last period) / dt
///
/// and the forces are those of the energy B w^2 / 2. While the sides have their rest lengths, that is
/// B (1 - cos(angle - rest)), and the moment B sin(angle - rest): linear for small bends, without a
/// force when folded. w is linear in the positions, so no pose is singular. It also resists unequal
/// elongations of its sides. The forces have no sum and no torque. For that, Z counts along w alone; while w
/// is 0, in all directions.
///
/// In 1 dimension a MAT moves across the line on which it stands, and the angle is a difference of slopes:
/// w = v / length_bc - u / length_ab - rest. In 3 dimensions a bend has no sign, and its rest is straight.
///
/// A bend with states takes B and Z from the state it is in; its conditions ask for the quantities of an angle.
/// A state may have laws beside B and Z. With s the length of w and angle(s) as BendOfLaw has it, the elasticity M adds
/// the moment M(angle) angle'(s) along w, of the energy whose slope over the angle is M. For sides of their rest lengths
/// the torque is M(bend). In 2 and 3 dimensions a law is that of a bend of at least 0, and acts alike the other way.
struct Bend {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  std::uint32_t mat_c = 0;
  double stiffness = 0.0;   ///< B [N m/rad], >= 0; 0 with states
  double viscosity = 0.0;   ///< Z [N m s/rad], >= 0; 0 with states
  double rest_angle = 0.0;  ///< at step 0 [rad], counter-clockwise from u to v; 0 in 3 dimensions
  double length_ab = 0.0;   ///< rest length of the sides [m], > 0
  double length_bc = 0.0;
  std::uint32_t state_machine = kNone;  ///< index in NetworkDescription::state_machines, or kNone

  static constexpr std::uint32_t kNone = 0xffffffffU;
  bool has_states() const noexcept { return state_machine != kNone; }
};

/// What the friction of a contact remembers at the start: see Friction. Members are numbered from those of P
/// on, then those of Q.
struct StartStretch {
  std::uint32_t member_a = 0;
  std::uint32_t member_b = 0;  ///< > member_a; of Q where there is one
  bool slides = false;
  Vec3 stretch = Vec3::Zero();  ///< the elongation of its spring [m]
};

/// One liaison between the sets P and Q, or within the set P: between each two of their MATs nearer
/// than `range`, as its state machine says. Members of a set are alike: the distance of a pair has
/// no sign in 1 dimension either, and there is no force while it is 0. With states, each pair has
/// one of its own, and begins in that of the start. A pair keeps its state while it is in range,
/// and beyond it while it is bound. It is bound in any other state than that of the start. The set
/// P may be surfaces, all of it, beside a set Q: then the distance of a pair is that of
/// SurfaceDistance, and there is a force at 0 too. [Luc90 III.2.3 a formalism for inter-connection]
struct SetLiaison {
  std::uint32_t state_machine = 0;   ///< index in NetworkDescription::state_machines
  std::vector<std::uint32_t> set_p;  ///< MATs, each once; or surfaces
  std::vector<std::uint32_t> set_q;  ///< MATs, none of them in P; empty: within P
  double range = 0.0;                ///< distance from which on there is no force [m], > 0
  double rest_length = 0.0;  ///< for each pair [m]; < 0: the sum of the radii of its two MATs
  /// Contacts with friction that lasts from before the start, by their members; those left out begin then.
  std::vector<StartStretch> stretches{};
};

/// All that a Network is assembled from. Forces are summed in a fixed order: links; state links, by
/// state machine and within one in the order given; Maxwell links; bends; sets.
struct NetworkDescription {
  int dimension = 3;  ///< 1, 2 or 3
  double step = 0.0;  ///< dt [s], > 0
  IntegratorKind integrator = IntegratorKind::kCordis;
  Vec3 gravity = Vec3::Zero();    ///< [m/s^2]; components beyond the dimension must be 0
  double medium_viscosity = 0.0;  ///< Z of the medium on masses that say none themselves [N s/m],
                                  ///< >= 0
  double freeze_tolerance = 0.0;  ///< masses that rest within it are left out, see Freezing; 0:
                                  ///< none [m]
  std::vector<std::uint32_t> kept_awake;  ///< MATs that never are, since their force is asked for
  std::vector<Mat> mats;
  std::vector<Link> links;
  std::vector<double> radius;  ///< [m], >= 0, one per MAT, or none at all
  std::vector<StateMachine> state_machines;
  std::vector<StateLink> state_links;
  std::vector<MaxwellLink> maxwell_links;
  std::vector<Bend> bends;
  std::vector<SetLiaison> sets;
  std::vector<Surface> surfaces;  ///< shapes of fixed MATs, at most one each
  std::vector<TimeFunction> time_functions;
  std::vector<Drive> drives;  ///< in the order of their MATs; of a position one each, forces add up
  std::vector<Variable> variables;        ///< scalars that conditions ask for: Operation::kVariable
  std::vector<VariableGroup> groups;      ///< what variables take together
  std::vector<ContactOfGroups> contacts;  ///< whose forces are added up in each step

  Vec3 gravity_on(const Mat& mat) const noexcept {
    return mat.weightless ? Vec3(Vec3::Zero()) : gravity;
  }
  /// Z of the medium on a mass [N s/m].
  double medium_viscosity_on(const Mat& mat) const noexcept {
    return mat.medium_viscosity < 0.0 ? medium_viscosity : mat.medium_viscosity;
  }
  bool has_medium() const noexcept;         ///< it takes something from a mass. O(MATs)
  std::size_t mass_count() const noexcept;  ///< MATs of kind kMass. O(MATs)
  /// The bend with the largest stiffness and the largest viscosity of its states. O(states)
  Bend stiffest_of(const Bend& bend) const noexcept;
  /// The bend in the state of the start.
  Bend at_start(const Bend& bend) const noexcept;
};

/// O(MATs + liaisons).
/// @throws std::invalid_argument naming the first MAT, link, state machine or set that is out of
///         range or not finite, or that joins a MAT to itself or to one that does not exist; when
///         no MAT is given; when dt^2 / m of a mass or Z / dt of a viscosity is not finite
void require_valid(const NetworkDescription& description);

/// A network of MATs (its nodes) and LIAs (its arcs), checked and laid out for stepping; immutable.
/// [Luc90 IV Assembly]
class Network {
 public:
  /// @throws std::invalid_argument as require_valid() does
  explicit Network(NetworkDescription description);
  /// Shares a description. Precondition: it is not null.
  explicit Network(std::shared_ptr<const NetworkDescription> description);

  const NetworkDescription& description() const noexcept { return *description_; }
  int dimension() const noexcept { return description_->dimension; }
  double step() const noexcept { return description_->step; }  ///< dt [s]
  std::size_t mat_count() const noexcept { return description_->mats.size(); }
  std::size_t link_count() const noexcept { return description_->links.size(); }
  std::size_t mass_count() const noexcept { return mass_count_; }

  /// 64-bit hash of the whole description: equal for networks assembled from the same values in the
  /// same order.
  std::uint64_t fingerprint() const noexcept { return fingerprint_; }

 private:
  std::shared_ptr<const NetworkDescription> description_;
  std::size_t mass_count_;
  std::uint64_t fingerprint_;
};

}  // namespace cordis::engine
