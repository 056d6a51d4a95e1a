// cli/ctl/control_words.h -- the words behind `cordis ctl`, made into a command.
#pragma once

#include <string>
#include <vector>

#include "idl/control.h"

namespace cordis::cli {

/// The part of a control/command that a person types.
struct ControlWords {
  msg::ControlVerb verb = msg::VERB_PAUSE;
  std::string argument;  ///< YAML
};

/// Makes the command of a verb and the words behind it. A path that exists here becomes an absolute
/// one; any other is left to the node, for which it starts at the folder of the launch file.
/// @throws UsageError when there is no such verb, or a word is missing, too many or malformed.
ControlWords read_control_words(const std::string& verb, const std::vector<std::string>& words);

/// The verbs with what they do, a line each, for help.
std::string control_verb_list();

}  // namespace cordis::cli
