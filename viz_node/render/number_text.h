// viz_node/render/number_text.h -- numbers as a person reads them, as in the page.
#pragma once

#include <string>

namespace cordis::viz {

/// A prefix of a unit: 1e-3 and "m".
struct Prefix {
  double factor = 1.0;
  const char* letter = "";
};

/// The prefix that brings `size` between 1 and 1000.
Prefix prefix_of(double size) noexcept;

/// Three significant digits at most and a prefix: "50 mm", "1.25 kN".
std::string with_unit(double value, const std::string& unit);

/// A share as percent, two digits or more: "0.50 %", "260 %".
std::string percent_text(double share);

/// The shortest text of a number with at most so many decimals: "0.5", "12".
std::string short_text(double value, int decimals);

/// The largest of 1, 2, 5, 10, 20 ... that is not above `length`. Precondition: length is
/// finite and > 0.
double round_length(double length) noexcept;

}  // namespace cordis::viz
