// tests/schema/word_uses.h -- the words of the languages, and those that shipped files use.
#pragma once

#include <set>
#include <string>

namespace cordis::test {

/// Every word that the readers of scenes, launch files and device files know: keys, the values of
/// choices but the default, quantities of signals, functions and variables of expressions.
/// "scene matter.NAME.kind: cylinder", "device mock.hand.stagger_s", "expression tanh".
std::set<std::string> known_words();

/// The words of known_words() that a file below launch_configs uses.
std::set<std::string> used_words();

}  // namespace cordis::test
