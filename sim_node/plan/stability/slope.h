// sim_node/plan/stability/slope.h -- how stiff and how viscous a liaison can become.
#pragma once

#include <limits>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// The largest slopes of a liaison: no tangent of its force is above them, whatever the pose and
/// the state it is in. Slopes below 0 (a compressed link gives way sideways) never count.
struct Slope {
  double stiffness = 0.0;  ///< [N/m]
  double viscosity = 0.0;  ///< [N s/m]
  bool bounded = true;     ///< false: they hold within the Reach alone
  /// The energy of a ball over the one that takes it to where the normal of a surface flips; 0 while that is
  /// negligible, else not bounded.
  double passing = 0.0;
  /// The energy that takes a ball there [J]; infinite: none does, or it is far from it.
  double barrier = std::numeric_limits<double>::infinity();
  bool law_is_bounded = true;  ///< false: not bounded, and not for `passing` alone
  /// By how much the slope along the liaison varies in one of its states [N/m]: 0 for a spring.
  double variation = 0.0;
  /// By how much it falls there, as slope_fall() has it [N/m]: where the energy of the Reach carries one of its states,
  /// and wherever it may be.
  double fall = 0.0;
  double fall_anywhere = 0.0;
  /// The most that the viscosity is over the stiffness in one of its states [s]; infinite where one is viscous and may
  /// have no stiffness.
  double damping_ratio = 0.0;
  /// The least that the viscosity is over the stiffness in one of the states that let go, where the slope jumps as they
  /// do [s]; infinite where none is so. A power of 1.5 and more begins without a jump.
  double touch_damping = std::numeric_limits<double>::infinity();
  /// Why nothing bounds them, not even the Reach; null: something does.
  const char* uncertainty = nullptr;
};

inline constexpr const char* kUnboundedVariable =
    "its law asks for a signal or a quantity that nothing bounds";
inline constexpr const char* kMayDriveApart =
    "what its law asks for may make it drive its ends apart";
inline constexpr const char* kMayDriveMotion =
    "what its law asks for may make it drive the motion by a viscosity below 0";

inline constexpr const char* kPassesSurface =
    "a ball may be driven so deep into the surface that the normal flips, and its force jumps";

/// True if a state acts at some distances and not at others.
bool lets_go(const engine::LinkState& state) noexcept;

/// Slope::damping_ratio of this viscosity and at least this stiffness [s].
double damping_ratio(double viscosity, double min_stiffness) noexcept;

/// True if a Slope::uncertainty is due to variables that the law asks for.
bool is_of_variables(const char* uncertainty) noexcept;

/// Friction gives way across the line of centres, and follows the push along it: the slope in any direction.
/// The slip is at most `static` times the push, as steep; derived in docs/stability.md. Over all states.
/// @param slope  of the state machine without friction
Slope with_friction(const Slope& slope, const engine::StateMachine& state_machine) noexcept;

/// Over all states of a state machine. [Luc90 III.2.3 b formalism to modify the liaison]
/// @param rest_length  of the liaison [m]; of a set, that of its nearest pair
/// @param dimension    of the network: in 1 dimension a link never turns
Slope largest_slope(const engine::StateMachine& state_machine, double rest_length, int dimension,
                    const Reach& reach);

/// Likewise of a liaison of a set with surfaces, whose distance has a sign. It turns beside an edge and
/// around a cylinder, and its normal flips where two nearest points are equally far.
/// @param flips_at  the largest distance at which it flips [m], at most 0: 0 at the corner of a box;
/// -infinity where it never does
/// Certain where nothing pulls there, and a ball does not come there with the energy of the reach.
Slope largest_slope_at_surfaces(const engine::StateMachine& state_machine, double rest_length,
                                double flips_at, const Reach& reach);

/// The radii of hollow cylinders [m].
struct HollowRadii {
  double narrowest = std::numeric_limits<double>::infinity();  ///< infinite without one
  double widest = 0.0;
};

/// Adds what a push gains across by the round wall of a hollow cylinder: a push P at the distance d from a wall of
/// the radius R has the stiffness P / (R - d) around its axis. Uncertain where anything acts on the axis.
/// @param slope        of the liaison at its surfaces, along the normal
/// @param rest_length  the longest [m]
Slope with_hollow(Slope slope, const engine::StateMachine& state_machine, const HollowRadii& radii,
                  double rest_length, const Reach& reach);

/// True if the force of a pair of a set of 1 dimension jumps where its ends pass each other, for it pulls there.
/// @param slope  of the liaison
bool pull_jumps_where_pairs_pass(const engine::StateMachine& state_machine, double rest_length,
                                 const Slope& slope, const Reach& reach);

/// Why the force of a link of 1 dimension that begins at a point jumps where its ends pass each other; null: it
/// does not. What pushes at positive distances pulls at negative ones, and `pulls: false` cuts it there: so from
/// behind nothing stops the ends.
const char* jumps_from_behind(const engine::StateMachine& state_machine,
                              const engine::LawPoint& point);

/// Why nothing is certain of ends that begin at one point; null: something is. Lennard-Jones has no force there,
/// and a force without a limit beside it.
const char* starts_at_one_point(const engine::StateMachine& state_machine,
                                const engine::LawPoint& point);

/// A state machine of the state of the start alone.
engine::StateMachine start_state_alone(const engine::StateMachine& state_machine);

/// What a state stores at a point [J], 0 where it is let go of. A force limit is not seen. Of an expression, which
/// has no closed form, the product of its tension and elongation.
double stored_in(const engine::LinkState& state, const engine::LawPoint& point);

/// Likewise in the state of the start.
double stored_in(const engine::StateMachine& state_machine, const engine::LawPoint& point);

/// The tangent of a liaison at one point without speed, in the state of its start. Where it does not act,
/// stiffness and viscosity are 0, or those of its fall on one side of where it just touches.
struct Tangent {
  double stiffness = 0.0;  ///< along the link, below 0 where a law falls [N/m]
  double viscosity = 0.0;  ///< likewise [N s/m]
  double tension = 0.0;    ///< where it does not act, only what it pushes with at its limit [N]
  bool acts = false;       ///< surely: neither let go of, nor about to be, nor at its limit
  bool sticks = false;     ///< its force over the speed is steeper than any number at rest
  bool jumps = false;      ///< its law has a step there or asks for variables, and so no tangent

  /// True when nothing is surely there.
  bool is_nothing() const noexcept {
    return !acts && !jumps && stiffness == 0.0 && viscosity == 0.0 && tension == 0.0;
  }
};

Tangent tangent_at_start(const engine::StateMachine& state_machine, const engine::LawPoint& point);

/// What a liaison pulls with at one point without speed, in the state of its start [N]; 0 where it pushes.
double tension_at_start(const engine::StateMachine& state_machine, const engine::LawPoint& point);

}  // namespace cordis::plan
