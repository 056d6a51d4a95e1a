// sim_node/run/command.h -- what a control/command wants of a simulation, read and checked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cordis::sim {

enum class Verb : std::uint8_t { kPause, kResume, kStep, kReset, kLoad, kSet, kState };

/// A parameter of a liaison or of named links, and its new value.
struct NewValue {
  std::string name;
  std::string parameter;
  double value = 0.0;
};

struct Command {
  Verb verb = Verb::kPause;
  std::uint64_t steps = 1;       ///< of kStep
  std::string scene_file;        ///< of kLoad
  std::vector<NewValue> values;  ///< of kSet, at least one
  std::string links;             ///< of kState: name, name[3] or name[2..5]
  std::string state;             ///< of kState
};

inline constexpr long kMaxSingleSteps = 1'000'000'000;

/// @param verb      a word of node::control_verbs()
/// @param argument  YAML
/// @throws std::invalid_argument with one sentence that says what is wrong
Command read_command(const std::string& verb, const std::string& argument);

}  // namespace cordis::sim
