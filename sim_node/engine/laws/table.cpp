// sim_node/engine/laws/table.cpp
#include "sim_node/engine/laws/table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {
namespace {

/// Slope of the piece that ends at point i.
double slope_before(const Table& table, std::size_t i) noexcept {
  return (table.value[i] - table.value[i - 1]) / (table.at[i] - table.at[i - 1]);
}

}  // namespace

void Table::check(const std::string& name) const {
  require(!at.empty(), name + ": table", "one of at least 1 point");
  require(at.size() == value.size(), name + ": table", "as long as its values");
  for (std::size_t i = 0; i < at.size(); ++i) {
    require(std::isfinite(at[i]) && std::isfinite(value[i]), name + ": table", "of finite points");
    if (i == 0) continue;
    require(at[i - 1] < at[i], name + ": points of the table", "strictly ascending");
    require(std::isfinite(slope_before(*this, i)), name + ": slope of the table", "finite");
  }
}

double Table::potential(double /*distance*/, double elongation) const noexcept {
  const auto value_at = [&](std::size_t i, double x) {
    return value[i - 1] + slope_before(*this, i) * (x - at[i - 1]);
  };
  const double low = std::min(0.0, elongation);
  const double high = std::max(0.0, elongation);
  double area = 0.0;
  if (low < at.front()) area += value.front() * (std::min(high, at.front()) - low);
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double from = std::max(low, at[i - 1]);
    const double to = std::min(high, at[i]);
    if (from < to) area += 0.5 * (value_at(i, from) + value_at(i, to)) * (to - from);
  }
  if (high > at.back()) area += value.back() * (high - std::max(low, at.back()));
  return elongation < 0.0 ? -area : area;
}

LawSlope Table::largest_slope(const LawRange& range) const noexcept {
  LawSlope slope;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i > 0) slope.value = std::max(slope.value, slope_before(*this, i));
    const double distance = range.rest_length + at[i];
    if (range.turns && distance > 0.0) slope.value = std::max(slope.value, value[i] / distance);
  }
  slope.bounded = !range.turns || value.front() <= 0.0;  // else it pulls on as the ends meet
  return slope;
}

double Table::smallest_slope(double /*elongation*/) const noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double smallest = kInfinity;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double slope = slope_before(*this, i);
    if (slope != 0.0) smallest = std::min(smallest, std::abs(slope));
  }
  return smallest < kInfinity ? smallest : 0.0;
}

}  // namespace cordis::engine
