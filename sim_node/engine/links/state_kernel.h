// sim_node/engine/links/state_kernel.h -- state machines for 8 rows at a time, compiled for each
// vector width.
//
// A row is a state link, or a pair of a set. Whoever owns the rows finds their kinematics, calls
// StepStateMachines, and puts the tensions on the MATs. As in step_kernel.h, nothing here has a member
// function, so that the linker never mixes up code of two widths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/expressions/program_term.h"
#include "sim_node/engine/laws/law_term.h"

namespace cordis::engine {

/// Index of a state in a StateTable, which numbers the states of all its state machines.
using StateIndex = std::uint32_t;
/// StateMachineRows::forced of a row that is not forced; exit of a change that was.
inline constexpr std::uint32_t kNotForced = 0xffffffffU;

/// What a change of state does with the rest length: RestRule as the kernels see it.
enum class RestCode : std::uint8_t { kKeep, kHere, kExpression };

struct TransitionTerm {
  ProgramTerm when;
  ProgramTerm rest_length;
  RestCode rest = RestCode::kKeep;
  StateIndex target = 0;
  Quantity triggered = Quantity::kNone;
};

/// A LinkState, made ready.
struct StateTerm {
  double stiffness = 0.0;          // K [N/m]
  double viscosity_over_dt = 0.0;  // Z / dt [N/m]
  double min_tension = 0.0;        // [N]; 0 when it does not push
  double max_tension = 0.0;        // [N]; 0 when it does not pull
  double min_elongation = 0.0;     // that its stored energy knows: 0 when it does not push [m]
  double max_elongation = 0.0;     // 0 when it does not pull
  bool one_sided = false;          // one of the two above is finite
  bool limited = false;            // one of the tensions above is finite
  bool limits_elastic = false;     // what it stores is the integral of the limited elastic tension
  LawTerm elasticity;
  LawTerm dissipation;
  const TransitionTerm* exits = nullptr;
  std::size_t exit_count = 0;
};

/// 8 rows; every array holds 8 values and is 64-byte aligned.
struct StateMachineRows {
  // given: what does not depend on the state, and all that the states' programs ask
  // for (StateTable::needs); what no state asks for may be null. quantity[kElongation], [kForce],
  // [kImpulse] and [kRestLength] are the arrays below.
  const double* quantity[kQuantityCount] = {};
  const double* elongation_increment = nullptr;  // of the row along its line of centres in this
                                                 // period [m]
  double dt = 0.0;                               // [s]
  double rate = 0.0;                             // 1 / dt [1/s]
  double now = 0.0;                              // step count
  std::uint32_t still = 0;                       // bit i: row i has no direction, hence no tension
  bool frozen = false;                           // no exit is tested: before step 0
  // given, and changed
  StateIndex* state = nullptr;
  double* rest_length = nullptr;  // [m]
  double* elongation = nullptr;   // distance - rest length [m]
  double* tension = nullptr;      // of the last step, then of this one [N]
  double* impulse = nullptr;      // since entry, this step included [N s]; may be null
  double* entered = nullptr;      // step count at the entry of the present state
  double* memory = nullptr;       // of slot s: memory[8 * s], 8 values, kNoValue at first
  std::size_t memory_slots = 0;
  std::uint32_t* forced = nullptr;  // target state or kNotForced, then kNotForced; may be null
  // found
  double* elastic = nullptr;         // the part of the tension that stores energy [N]
  double* elastic_before = nullptr;  // that of the state before the change; valid where one changed
  std::uint32_t changed = 0;         // bit i: row i has changed
  StateIndex from[kStateBatch];      // valid where changed:
  std::uint32_t exit[kStateBatch];   // number among the exits of `from`, or kNotForced
  double trigger_value[kStateBatch];  // of the quantity that triggered
  double rest_before[kStateBatch];    // [m]
};

/// One step of the state machines of 8 rows: exits of the present state in order, at most one
/// change a row, tension of the state it is in then. Updates impulse, entered and memory. In a row
/// that has changed, the dampers see no elongation increment.
using StepStateMachines = void (*)(const StateTerm* states, StateMachineRows& rows) noexcept;

/// Rows in one state without exits; arrays 64-byte aligned, padded to a multiple of 8.
struct PlainRows {
  std::size_t count = 0;                         // rows
  const double* distance = nullptr;              // [m]
  const double* inverse = nullptr;               // of the distance, 0 while it is 0 [1/m]
  const double* elongation_increment = nullptr;  // [m]
  const double* rest_length = nullptr;           // [m]
  const double* mass_a = nullptr;                // [kg]; may be null unless its law asks for it
  const double* mass_b = nullptr;
  double rate = 0.0;                 // 1 / dt [1/s]
  double* factor = nullptr;          // tension / distance [N/m]
  double* viscous_factor = nullptr;  // of the part that stores no energy
};

/// Finds the tensions of all rows; 0 while the distance is.
using FindTensions = void (*)(const StateTerm& state, const PlainRows& rows) noexcept;

/// State links, one row each; arrays 64-byte aligned, padded to a multiple of 8 with rows that join
/// a MAT to itself in a state of no force.
struct StateLinkRows {
  std::size_t count = 0;                    // rows, padding included
  const std::uint32_t* column_a = nullptr;  // 4 * MAT index
  const std::uint32_t* column_b = nullptr;
  const double* mass_a = nullptr;  // [kg]
  const double* mass_b = nullptr;
  const StateTerm* states = nullptr;
  StateIndex* state = nullptr;
  double* rest_length = nullptr;  // as in StateMachineRows, all of these
  double* tension = nullptr;
  double* impulse = nullptr;
  double* entered = nullptr;
  double* memory = nullptr;  // of row l, slot s: memory[(l / 8 * memory_slots + s) * 8 + l % 8]
  std::size_t memory_slots = 0;
  std::uint32_t* forced = nullptr;
  double* elastic_factor = nullptr;  // elastic force of the last call = factor * vector from a to
  double* viscous_factor = nullptr;  // b; the rest of the force; both [N/m], in 1 dimension [N]
  double dt = 0.0;                   // [s]
  double rate = 0.0;                 // 1 / dt [1/s]
  double now = 0.0;                  // step count
  bool frozen = false;               // no exit is tested
  bool needs_velocity = false;       // some program asks for it, or for the slip
  bool needs_age = false;
  // called after a batch in which rows have changed
  void (*on_change)(void* owner, std::size_t first_row,
                    const StateMachineRows& rows) noexcept = nullptr;
  void* owner = nullptr;
};

struct ForceColumns;
struct LinkWork;

/// Steps the state machines of all links and adds their forces, in link order, and their works as
/// AddLinkForces counts them: of the elastic parts of the tensions, and of the rest.
using AddStateLinkForces = void (*)(const StateLinkRows& links, const ForceColumns& columns,
                                    LinkWork& work) noexcept;

/// Maxwell elements, one row each; arrays 64-byte aligned, padded to a multiple of 8 with elements
/// of no force.
struct MaxwellRows {
  std::size_t count;              // rows, padding included
  const std::uint32_t* column_a;  // 4 * MAT index
  const std::uint32_t* column_b;
  const double* velocity_retention;  // e^(-K dt / Z)
  const double* gain;                // Z (1 - velocity retention) / dt [N/m]
  const double* compliance;          // 1 / K [m/N]
  double* tension;                   // [N]
  double* factor;                    // force of the last call = factor * vector from a to b
};

/// Adds the forces of all elements, in order, and their works as AddStateLinkForces; elastic is the
/// change of what their springs store.
using AddMaxwellForces = void (*)(const MaxwellRows& links, const ForceColumns& columns,
                                  LinkWork& work) noexcept;

/// The loops of one width.
struct StateKernel {
  StepStateMachines step = nullptr;
  FindTensions tensions = nullptr;
  AddStateLinkForces state_links_1d = nullptr;
  AddStateLinkForces state_links_3d = nullptr;  // for 2 dimensions too
  AddMaxwellForces maxwell_1d = nullptr;
  AddMaxwellForces maxwell_3d = nullptr;
};

extern const StateKernel kStateKernelSse2;
extern const StateKernel kStateKernelAvx2;
extern const StateKernel kStateKernelAvx512;

const StateKernel& state_kernel(VectorWidth width) noexcept;

}  // namespace cordis::engine
