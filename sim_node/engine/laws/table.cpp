// sim_node/engine/laws/table.cpp
#include "sim_node/engine/laws/table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {

Table::Table(std::vector<double> argument, std::vector<double> value)
    : argument_(std::move(argument)), value_(std::move(value)) {
  find_slopes();
}

void Table::find_slopes() {
  slope_.assign(argument_.size(), 0.0);
  for (std::size_t i = 1; i < std::min(argument_.size(), value_.size()); ++i) {
    slope_[i - 1] = (value_[i] - value_[i - 1]) / (argument_[i] - argument_[i - 1]);
  }
}

void Table::check(const std::string& name) const {
  require(!argument_.empty(), name + ": table", "one of at least 1 point");
  require(argument_.size() == value_.size(), name + ": table", "as long as its values");
  for (std::size_t i = 0; i < argument_.size(); ++i) {
    require(std::isfinite(argument_[i]) && std::isfinite(value_[i]), name + ": table",
            "of finite points");
    if (i == 0) continue;
    require(argument_[i - 1] < argument_[i], name + ": points of the table", "strictly ascending");
    require(std::isfinite(slope_[i - 1]), name + ": slope of the table", "finite");
  }
}

double Table::potential(double /*distance*/, double elongation) const noexcept {
  const double low = std::min(0.0, elongation);
  const double high = std::max(0.0, elongation);
  double area = 0.0;
  if (low < argument_.front()) area += value_.front() * (std::min(high, argument_.front()) - low);
  for (std::size_t i = 1; i < argument_.size(); ++i) {
    const auto value_at = [&](double x) {
      return value_[i - 1] + slope_[i - 1] * (x - argument_[i - 1]);
    };
    const double begin = std::max(low, argument_[i - 1]);
    const double end = std::min(high, argument_[i]);
    if (begin < end) area += 0.5 * (value_at(begin) + value_at(end)) * (end - begin);
  }
  if (high > argument_.back()) area += value_.back() * (high - std::max(low, argument_.back()));
  return elongation < 0.0 ? -area : area;
}

LawSlope Table::largest_slope(const LawRange& range) const noexcept {
  LawSlope slope;
  for (std::size_t i = 0; i < argument_.size(); ++i) {
    slope.value = std::max(slope.value, slope_[i]);
    const double distance = range.rest_length + argument_[i];
    if (range.turns && distance > 0.0) slope.value = std::max(slope.value, value_[i] / distance);
  }
  slope.bounded = !range.turns || value_.front() <= 0.0;  // else it pulls on as the ends meet
  return slope;
}

double Table::smallest_slope(double /*elongation*/) const noexcept {
  double smallest = 0.0;
  for (const double slope : slope_) {
    const double size = std::abs(slope);
    if (size != 0.0 && (smallest == 0.0 || size < smallest)) smallest = size;
  }
  return smallest;
}

}  // namespace cordis::engine
