// sim_node/plan/table_pulse.cpp
#include "sim_node/plan/table_pulse.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace cordis::plan {
namespace {

constexpr double kWorthOf = 0.1;  // the height of a pulse, of the range of its table

/// Where a table turns about along an axis, and its ends: what turns by less than `least` goes on.
std::vector<std::size_t> turns_of(const engine::TimeFunction& table, int axis, double least) {
  const auto height_of = [&](std::size_t i) { return table.value[i][axis]; };
  std::vector<std::size_t> turns;
  std::size_t lowest = 0;
  std::size_t highest = 0;
  int direction = 0;
  for (std::size_t i = 1; i < table.value.size(); ++i) {
    if (height_of(i) > height_of(highest)) highest = i;
    if (height_of(i) < height_of(lowest)) lowest = i;
    if (direction >= 0 && height_of(highest) - height_of(i) >= least) {
      turns.push_back(highest);
      direction = -1;
      lowest = i;
    } else if (direction <= 0 && height_of(i) - height_of(lowest) >= least) {
      turns.push_back(lowest);
      direction = 1;
      highest = i;
    }
  }
  turns.push_back(direction < 0 ? lowest : highest);
  return turns;
}

/// When a table is first at a value between two of its times.
double time_at(const engine::TimeFunction& table, int axis, std::size_t from, std::size_t to,
               double level) {
  for (std::size_t i = from; i < to; ++i) {
    const double left = table.value[i][axis] - level;
    const double right = table.value[i + 1][axis] - level;
    if (left * right > 0.0 || left == right) continue;
    return table.time[i] + left / (left - right) * (table.time[i + 1] - table.time[i]);
  }
  return table.time[to];
}

void consider_axis(const engine::TimeFunction& table, int axis, std::uint32_t drive,
                   std::optional<TablePulse>& narrowest) {
  const auto height_of = [&](std::size_t i) { return table.value[i][axis]; };
  const auto [lowest, highest] = std::ranges::minmax_element(
      table.value, {}, [axis](const engine::Vec3& value) { return value[axis]; });
  const double range = (*highest)[axis] - (*lowest)[axis];
  if (!(range > 0.0)) return;
  const std::vector<std::size_t> turns = turns_of(table, axis, kWorthOf * range);
  for (std::size_t i = 1; i + 1 < turns.size(); ++i) {
    if (!(table.time[turns[i + 1]] > 0.0)) continue;
    const double rise = height_of(turns[i]) - height_of(turns[i - 1]);
    const double fall = height_of(turns[i]) - height_of(turns[i + 1]);
    const double height = std::min(std::abs(rise), std::abs(fall));
    const double level = height_of(turns[i]) - 0.5 * std::copysign(height, rise);
    const double begin = time_at(table, axis, turns[i - 1], turns[i], level);
    const double end = time_at(table, axis, turns[i], turns[i + 1], level);
    if (narrowest && end - begin >= narrowest->width) continue;
    narrowest = {drive, table.time[turns[i]], end - begin};
  }
}

}  // namespace

std::optional<TablePulse> narrowest_pulse(const engine::NetworkDescription& network) {
  std::optional<TablePulse> narrowest;
  std::vector<bool> is_known(network.time_functions.size());
  for (std::uint32_t i = 0; i < network.drives.size(); ++i) {
    const std::uint32_t function = network.drives[i].function;
    if (is_known[function]) continue;
    is_known[function] = true;
    const engine::TimeFunction& table = network.time_functions[function];
    if (table.time.empty()) continue;
    for (int axis = 0; axis < network.dimension; ++axis) consider_axis(table, axis, i, narrowest);
  }
  return narrowest;
}

}  // namespace cordis::plan
