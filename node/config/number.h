// node/config/number.h -- numbers that a person wrote, and as a person reads them.
#pragma once

#include <limits>
#include <string>

#include "node/config/problem.h"
#include "node/config/value.h"

namespace cordis::config {

/// What a number may be. Both ends belong to the range unless said otherwise.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool lowest_excluded = false;
  const char* hint = "";  ///< for who needs a number outside

  static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static Range not_negative() { return {0.0, std::numeric_limits<double>::infinity(), false}; }
  static Range between(double lowest, double highest) { return {lowest, highest, false}; }
};

/// A scalar as a finite number; a problem and the fallback otherwise. `what` names it in the
/// message. A number is written as 3, -0.5 or 1e-3: not in quotes, not .inf or .nan, not beyond a
/// double.
double read_number(const Value& value, const std::string& what, double fallback, Range range,
                   Problems& problems);

/// A scalar as a whole number within the range, both ends included; a problem and the fallback
/// otherwise.
long read_integer(const Value& value, const std::string& what, long fallback, long lowest,
                  long highest, Problems& problems);

/// The hint for a formula in the place of a number.
inline constexpr const char* kNoFormula = "write one number: this takes no formula";

/// A number in a short form that reads back as itself, for messages.
std::string number_text(double number);

}  // namespace cordis::config
