// cli/table/column.h -- what a column of a table holds.
#pragma once

#include <string>
#include <vector>

namespace cordis::cli {

struct Column {
  std::string name;
  std::string unit;  ///< empty: a number without one
};

/// `bridge [N]`, or the name alone.
inline std::string header_of(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

}  // namespace cordis::cli
