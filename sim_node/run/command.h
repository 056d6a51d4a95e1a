// sim_node/run/command.h -- what a control/command wants of a simulation, read and checked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/control.h"

namespace cordis::sim {

/// A parameter of a liaison or of named links, and its new value.
struct NewValue {
  std::string name;
  std::string parameter;
  double value = 0.0;
};

struct Command {
  msg::ControlVerb verb = msg::VERB_PAUSE;
  std::uint64_t steps = 1;         ///< steps for VERB_STEP
  std::string scene_file;          ///< file for VERB_LOAD
  std::vector<NewValue> values;    ///< values for VERB_SET, at least one
  std::vector<std::string> names;  ///< for VERB_GET: NAME or NAME.PARAMETER; none: all of the scene
  std::string links;               ///< links for VERB_STATE: name, name[3] or name[2..5]
  std::string state;               ///< new state for VERB_STATE
  double time_scale = 1.0;         ///< simulated time per real time, for VERB_RATE
};

inline constexpr long kMaxSingleSteps = 1'000'000'000;

/// @param verb      as another process wrote it: any number
/// @param argument  YAML
/// @throws std::invalid_argument with one sentence that says what is wrong
[[nodiscard]] Command read_command(msg::ControlVerb verb, const std::string& argument);

}  // namespace cordis::sim
