// sim_node/scene/liaisons/state_machine.h -- liaisons with states, as a scene writes them.
#pragma once

#include <string>
#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/scene/language/formula.h"

namespace cordis::scene {

/// What friction looks like in a file.
inline constexpr const char* kExampleOfFriction =
    "friction: {static: 0.5, stiffness_n_per_m: 3000, viscosity_n_s_per_m: 2}";

/// Where the parts of a state machine stand, and what was said about them beside their physics.
struct StateMachinePlaces {
  struct State {
    config::Place place;
    bool is_final = false;  ///< the person knows that nothing leads out of it
  };
  std::vector<State> states;
  std::vector<config::Place> exits;  ///< where their conditions stand
  std::vector<config::Place> rests;  ///< where the rules for their rest lengths stand
};

/// Reads the keys `friction`, `states` and `start`, or those of a single state, which then stand in the liaison
/// itself. Whatever is wrong is a problem; then the state machine is not to be used. What its conditions ask for
/// outside their link are references, until bind() puts variables in their place.
/// The language is described in docs/language.md. [Luc90 III.2.3 b formalism to modify the liaison]
engine::StateMachine read_state_machine(config::MappingReader& reader,
                                        const ParameterValues& parameters, AskedOutside& outside,
                                        StateMachinePlaces& places, config::Problems& problems);

/// Reads `states` and `start` of a liaison that resists bending, whose conditions ask for an angle. In 3 dimensions
/// the rest of each state is straight. Whatever is wrong is a problem, as above.
/// Precondition: the liaison has `states`.
engine::StateMachine read_bend_states(config::MappingReader& reader, int space,
                                      const ParameterValues& parameters, AskedOutside& outside,
                                      StateMachinePlaces& places, config::Problems& problems);

/// True if the keys of a liaison without `kind` can only be those of a state machine.
bool looks_like_state_machine(const config::Value& liaison);

}  // namespace cordis::scene
