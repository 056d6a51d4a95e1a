// node/control_verbs.h -- the verbs of control/command for a sim_node or a player, in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "idl/control.h"

namespace cordis::node {

struct ControlVerb {
  msg::ControlVerb verb;
  const char* name;
  const char* words;    ///< what follows it on a command line
  const char* summary;  ///< for help
};

inline const std::vector<ControlVerb>& control_verbs() {
  static const std::vector<ControlVerb> kVerbs{
      {msg::VERB_PAUSE, "pause", "", "Pause the scene"},
      {msg::VERB_RESUME, "resume", "", "Let it go on"},
      {msg::VERB_STEP, "step", "[N]", "Pause, then do one step, or N"},
      {msg::VERB_RESET, "reset", "", "Restart the scene, with its present parameters"},
      {msg::VERB_LOAD, "load", "SCENE", "Play another scene from its beginning"},
      {msg::VERB_SET, "set", "NAME.PARAMETER=VALUE ...",
       "Change parameters of liaisons, named links or the world"},
      {msg::VERB_STATE, "state", "LINKS STATE", "Put links into a state"},
      {msg::VERB_GET, "get", "[NAME[.PARAMETER] ...]", "Say what parameters are now"},
      {msg::VERB_SEEK, "seek", "TIME", "Go to this time of a take that is played"},
      {msg::VERB_RATE, "rate", "RATE",
       "Play so many times as fast as recorded, or as in real time: 0.01 to 1"},
  };
  return kVerbs;
}

/// The verb of a word; nullptr when there is none.
inline const ControlVerb* find_control_verb(std::string_view name) {
  for (const ControlVerb& verb : control_verbs()) {
    if (name == verb.name) return &verb;
  }
  return nullptr;
}

/// The word of a verb. A number that another process wrote and that is none gets `verb 99`.
inline std::string word_of(msg::ControlVerb wanted) {
  for (const ControlVerb& verb : control_verbs()) {
    if (verb.verb == wanted) return verb.name;
  }
  return "verb " + std::to_string(static_cast<unsigned>(wanted));
}

inline std::vector<std::string> control_verb_names() {
  std::vector<std::string> names;
  for (const ControlVerb& verb : control_verbs()) names.emplace_back(verb.name);
  return names;
}

}  // namespace cordis::node
