// sim_node/command.h -- what a control/command wants of a simulation, read and checked.
#pragma once

#include <cstdint>
#include <string>

namespace cordis::sim {

enum class Verb : std::uint8_t { kPause, kResume, kStep, kReset, kLoad };

struct Command {
  Verb verb = Verb::kPause;
  std::uint64_t steps = 1;  ///< of kStep
  std::string scene_file;   ///< of kLoad
};

inline constexpr long kMostSingleSteps = 1'000'000'000;

/// @param verb      a word of node::control_verbs()
/// @param argument  YAML
/// @throws std::invalid_argument with one sentence that says what is wrong
Command read_command(const std::string& verb, const std::string& argument);

}  // namespace cordis::sim
