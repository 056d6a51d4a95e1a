// node/step_troubles.h -- what may go wrong in the steps of a scene, for a person.
#pragma once

namespace cordis::node {

/// What a number of a status or of a simulation counts; the number follows.
inline constexpr const char* kOverflowedSteps = "steps with more pairs in range than room, slow";
inline constexpr const char* kForgottenPairs = "states of pairs FORGOTTEN for lack of memory";
inline constexpr const char* kRefusedInputs =
    "positions, forces and parameters refused, not finite";

}  // namespace cordis::node
