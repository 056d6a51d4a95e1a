// sim_node/engine/laws/law_field.h -- one number or list of a law, as a scene writes it.
#pragma once

#include <limits>

namespace cordis::engine {

/// A law gives each of its fields to a function, with the reference to its value, in the order in
/// which they count in the fingerprint. The values are numbers, lists of numbers, or lists of types
/// that have fields themselves.
struct LawField {
  const char* key;  ///< in a scene; nullptr: the key of what the law is a function of
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_excluded = false;
  bool is_optional = false;         ///< 0 when it is not written
  double multiple_of = 0.0;         ///< 0: any number of the range
  const char* hint = "";            ///< for who needs another number
  const char* bend_key = nullptr;   ///< in a law of a bend, where that is another
  const char* bend_hint = nullptr;  ///< likewise
  bool ascends = false;             ///< a list; strictly
  bool as_many_as_first = false;    ///< a list as long as the first of the law
  bool follows = false;             ///< a number that may follow variables of the network
};

}  // namespace cordis::engine
