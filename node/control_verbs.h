// node/control_verbs.h -- the verbs of control/command that a sim_node executes.
#pragma once

#include <string>
#include <vector>

namespace cordis::node {

struct ControlVerb {
  const char* name;
  const char* words;    ///< what follows it on a command line
  const char* summary;  ///< for help
};

inline const std::vector<ControlVerb>& control_verbs() {
  static const std::vector<ControlVerb> kVerbs{
      {"pause", "", "Pause the scene"},
      {"resume", "", "Let it go on"},
      {"step", "[N]", "Pause, then do one step, or N"},
      {"reset", "", "Restart the scene, with its present parameters"},
      {"load", "SCENE", "Play another scene from its beginning"},
      {"set", "NAME.PARAMETER=VALUE ...", "Change parameters of liaisons or named links"},
      {"state", "LINKS STATE", "Put links into a state"},
  };
  return kVerbs;
}

inline std::vector<std::string> control_verb_names() {
  std::vector<std::string> names;
  for (const ControlVerb& verb : control_verbs()) names.emplace_back(verb.name);
  return names;
}

}  // namespace cordis::node
