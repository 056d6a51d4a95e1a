// sim_node/engine/description/state_machine.h -- what a liaison with states is.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/expressions/program.h"
#include "sim_node/engine/laws/law.h"

namespace cordis::engine {

/// Coulomb friction across the line of centres of the contacts of a set: a spring with memory and a
/// damper, up to a share of the force with which the liaison pushes.
///
///     force = K s + Z w,  |force| <= static * push while it sticks, kinetic * push once it slides
///
/// with s what the contact has slid since it began, as far as the spring has followed, and w the sliding
/// velocity. A contact that slides sticks again when it turns back and the force is within that of one that sticks.
/// A contact that does not push has no friction, and its spring starts again at 0. Nor has one in a state without
/// friction. Where the new state has another friction, the spring keeps its force, or its stretch where that is
/// less energy. [Cundall and Strack 1979]
struct Friction {
  double static_coefficient = 0.0;   ///< >= kinetic_coefficient
  double kinetic_coefficient = 0.0;  ///< >= 0
  double stiffness = 0.0;            ///< K [N/m], > 0; 0: no friction
  double viscosity = 0.0;            ///< Z [N s/m], >= 0

  bool acts() const noexcept { return stiffness > 0.0; }
  friend bool operator==(const Friction&, const Friction&) = default;
};

/// What else than a stiffness and a viscosity a formula may change in a state.
enum class Parameter : std::uint8_t {
  kRestAngle,        ///< rest angle of a bend; it comes before any other
  kStaticFriction,   ///< coefficient of the friction in this state
  kKineticFriction,  ///< likewise; at most the static one
  kDepth             ///< LennardJones::well_depth of its elasticity
};

/// A parameter that follows variables of the network. A value that is below 0 or not finite counts
/// as 0. An angle may be below 0, and stays what it was where it is not finite.
struct ParameterFormula {
  Parameter parameter = Parameter::kRestAngle;
  Program formula;  ///< asks for variables alone
};

/// A state describer: the parameters of the liaison while it is in this state.
///
///     tension = K e + elasticity + Z v + dissipation
///
/// with e the elongation and v its elongation rate, positive pulling the ends
/// together; then without its positive part unless `pulls`, without its negative part unless
/// `pushes`, then within +- force_limit. In the step in which the state is entered the delayed
/// distance is the present one: v is 0, and no viscosity answers to what happened before. It stores
/// the integral of K e + elasticity, within +- force_limit where there is one. A stiffness that follows variables
/// is an elasticity of that factor times e, a viscosity a dissipation of that factor times v.
struct LinkState {
  std::string name;
  double stiffness = 0.0;  ///< K [N/m], >= 0
  double viscosity = 0.0;  ///< Z [N s/m], >= 0
  Law elasticity;          ///< added to K
  Law dissipation;         ///< added to Z
  bool pulls = true;       ///< false: clamped, no pulling at the release of a contact
  bool pushes = true;      ///< false: a thread
  double force_limit = std::numeric_limits<double>::infinity();  ///< [N], > 0
  std::optional<Friction> friction{};  ///< its own; without one that of the state machine
  /// Rest angle that a bend takes as it enters the state, unless the exit has a rule [rad].
  std::optional<double> rest_angle{};
  std::vector<ParameterFormula> formulas{};  ///< what they change is 0 here; at most one of each
  std::uint32_t first_exit = 0;  ///< its exits are State machine::exits[first_exit, last_exit)
  std::uint32_t last_exit = 0;
};

/// What a change of state does with the rest length.
enum class RestRule : std::uint8_t {
  kKeep = 0,
  kHere = 1,  ///< becomes the present distance: the points of hook-up are renewed
  kExpression =
      2  ///< becomes the value of Transition::rest_length, before the change: plastic flow
};

/// A state change condition, and where it leads.
struct Transition {
  Program when;
  std::uint32_t target = 0;  ///< a state of the state machine; may be the state itself
  RestRule rest = RestRule::kKeep;
  Program rest_length;                         ///< new length, for kExpression alone
  Quantity triggered = Quantity::kElongation;  ///< the one an event shows: the first of the
                                               ///< condition
};

/// A liaison with states. Each step finds, for each link, the quantities first. Then come the exits
/// of its present state in the order written. The first that holds changes the state. The tension
/// is that of the state it is in then. So a link changes at most once a step. [Luc90 III.2.3 b
/// formalism to modify the liaison]
struct StateMachine {
  std::string name;
  std::vector<LinkState> states;
  std::vector<Transition> exits;
  std::uint32_t start = 0;  ///< state at step 0
  Friction friction{};  ///< in states without one of their own; of sets in 2 or 3 dimensions alone

  bool is_stateless() const noexcept { return states.size() == 1 && exits.empty(); }
};

/// The friction in a state. Precondition: the state exists.
const Friction& friction_in(const StateMachine& state_machine, std::size_t state) noexcept;

/// The laws of a bend in a state beside its stiffness and its viscosity; null: there is none. A factor of variables
/// times the elongation, or the speed, counts as a stiffness or a viscosity. The elongation of a law is the bend, the
/// speed its rate: see BendOfLaw.
struct LawsOfBend {
  const Law* elasticity = nullptr;
  const Law* dissipation = nullptr;

  bool any() const noexcept { return elasticity != nullptr || dissipation != nullptr; }
};

/// Laws of the state itself, which must outlive them.
LawsOfBend laws_of_bend(const LinkState& state) noexcept;
/// True if one of its states has such a law.
bool has_laws_of_bends(const StateMachine& state_machine) noexcept;

/// What a bend cannot have in a state: `elasticity` and so on; nullptr when it takes all of it.
const char* refused_in_bends(const StateMachine& state_machine) noexcept;
/// True if a Maxwell element takes K and Z from it: one state, with these two alone.
bool fits_maxwell_element(const StateMachine& state_machine) noexcept;
/// The formula of a parameter in a state; null without one.
const Program* formula_of(const LinkState& state, Parameter parameter) noexcept;
/// True if a program of it asks for a quantity of an angle.
bool asks_for_angle(const StateMachine& state_machine) noexcept;

/// True if there is friction in any of its states.
bool rubs(const StateMachine& state_machine) noexcept;

/// The distance below which a pair of a set counts as partners [m]: infinite, for every pair that
/// exerts a force, except for Lennard-Jones alone. That law is stiff below its inflection,
/// (26/7)^(1/6) diameters, and beyond it its slopes are below 0.4 % of those in its well.
double touch_distance(const StateMachine& state_machine) noexcept;

/// The most states a state machine may have.
inline constexpr std::size_t kMaxStates = 64;

/// True if a law or a formula of a state asks for a variable of the network. Then its force may change whatever
/// its own link does.
bool asks_for_variable(const LinkState& state) noexcept;
/// True if a law of any of its states does.
bool laws_ask_for_variable(const StateMachine& state_machine) noexcept;
/// True if a condition, a law or a formula asks for a variable of the network.
bool asks_for_variable(const StateMachine& state_machine) noexcept;

/// @param variable_count  how many variables its conditions and laws may ask for
/// @throws std::invalid_argument beginning with `name`, with the first thing that is wrong: no
/// state, a value out of range, an exit or a target that does not exist, a program that is not
/// well-formed, a slot used twice by the exits of a state.
void check_state_machine(const StateMachine& state_machine, const std::string& name,
                         std::size_t variable_count = 0);

}  // namespace cordis::engine
