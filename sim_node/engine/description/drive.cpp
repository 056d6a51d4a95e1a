// sim_node/engine/description/drive.cpp
#include "sim_node/engine/description/drive.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/assert.h"
#include "sim_node/engine/core/require.h"
#include "sim_node/engine/description/network.h"

namespace cordis::engine {
namespace {

/// Slope at a value of a smooth table, from the slopes of the straight lines beside it over their times:
/// their harmonic mean, weighted, or 0 where they have different signs.
double smooth_slope(double before, double after, double time_before, double time_after) noexcept {
  if (!(before * after > 0.0)) return 0.0;
  const double weight_before = time_before + 2.0 * time_after;
  const double weight_after = 2.0 * time_before + time_after;
  return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

/// Slope of one axis at a time of a smooth table; at its ends 0, where it rests.
double slope_at(const TimeFunction& table, std::size_t index, int axis) noexcept {
  if (index == 0 || index + 1 == table.time.size()) return 0.0;
  const double time_before = table.time[index] - table.time[index - 1];
  const double time_after = table.time[index + 1] - table.time[index];
  const double before = (table.value[index][axis] - table.value[index - 1][axis]) / time_before;
  const double after = (table.value[index + 1][axis] - table.value[index][axis]) / time_after;
  return smooth_slope(before, after, time_before, time_after);
}

Vec3 in_table(const TimeFunction& table, double time) noexcept {
  const auto next = std::upper_bound(table.time.begin(), table.time.end(), time);
  if (next == table.time.begin()) return table.value.front();
  if (next == table.time.end()) return table.value.back();
  const auto right = static_cast<std::size_t>(next - table.time.begin());
  const std::size_t left = right - 1;
  const double width = table.time[right] - table.time[left];
  const double share = (time - table.time[left]) / width;
  Vec3 value;
  for (int axis = 0; axis < 3; ++axis) {
    const double begin = table.value[left][axis];
    const double way = table.value[right][axis] - begin;
    value[axis] = begin + share * way;
    if (!table.smooth) continue;
    const double excess_left = width * slope_at(table, left, axis) - way;
    const double excess_right = width * slope_at(table, right, axis) - way;
    value[axis] += share * (1.0 - share) * ((1.0 - share) * excess_left - share * excess_right);
  }
  return value;
}

/// True if a quantity may stand in a formula: the time, place and velocity along the axes there are.
bool is_known_to_functions(Quantity quantity, int dimension) noexcept {
  if (quantity == Quantity::kAge) return true;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    if (quantity == kPlaceInForce[axis] || quantity == kVelocityInForce[axis]) return true;
  }
  return false;
}

/// The transpose of the turn of a drive times a vector.
Vec3 turned_back(const Drive& drive, const Vec3& value) noexcept {
  const std::array<double, 9>& m = drive.turn;
  return {m[0] * value.x() + m[3] * value.y() + m[6] * value.z(),
          m[1] * value.x() + m[4] * value.y() + m[7] * value.z(),
          m[2] * value.x() + m[5] * value.y() + m[8] * value.z()};
}

/// True if the turn of a drive keeps lengths and angles.
bool is_rotation(const Drive& drive) noexcept {
  constexpr double kRounding = 1e-9;
  for (int axis = 0; axis < 3; ++axis) {
    Drive plain = drive;
    plain.is_force = true;
    const Vec3 unit = Vec3::Unit(axis);
    if (!((turned_back(drive, placed(plain, unit)) - unit).norm() < kRounding)) return false;
  }
  return true;
}

}  // namespace

bool asks_for_motion(const TimeFunction& function) noexcept {
  return std::ranges::any_of(function.formula, [](const Program& formula) {
    return std::ranges::any_of(formula.code, [](const Instruction& instruction) {
      return instruction.operation == Operation::kQuantity &&
             instruction.quantity != Quantity::kAge;
    });
  });
}

bool asks_for_variable(const TimeFunction& function) noexcept {
  return std::ranges::any_of(function.formula,
                             [](const Program& formula) { return asks_for_variable(formula); });
}

bool is_of_time(const TimeFunction& function) noexcept {
  return !asks_for_motion(function) && !asks_for_variable(function);
}

Vec3 value_at(const TimeFunction& function, const FunctionPoint& point) noexcept {
  if (!function.time.empty()) return in_table(function, point.time);
  LinkQuantities quantities{};
  quantities[static_cast<std::size_t>(Quantity::kAge)] = point.time;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    quantities[static_cast<std::size_t>(kPlaceInForce[axis])] =
        point.position[static_cast<int>(axis)];
    quantities[static_cast<std::size_t>(kVelocityInForce[axis])] =
        point.velocity[static_cast<int>(axis)];
  }
  Vec3 value = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Program& formula = function.formula[axis];
    if (formula.empty()) continue;
    value[static_cast<int>(axis)] = value_of(formula, quantities, nullptr, 0.0, point.variables);
  }
  return value;
}

Vec3 value_at(const TimeFunction& function, double time) noexcept {
  FunctionPoint point;
  point.time = time;
  return value_at(function, point);
}

double speed_bound_of_table(const TimeFunction& table) noexcept {
  double largest = 0.0;
  for (std::size_t left = 0; left + 1 < table.time.size(); ++left) {
    const double width = table.time[left + 1] - table.time[left];
    Vec3 steepest = (table.value[left + 1] - table.value[left]) / width;
    // A cubic that stays between two values is at most three times as steep as the line.
    if (table.smooth) steepest *= 3.0;
    largest = std::max(largest, steepest.norm());
  }
  return largest;
}

Vec3 placed(const Drive& drive, const Vec3& value) noexcept {
  const std::array<double, 9>& m = drive.turn;
  const Vec3 turned(m[0] * value.x() + m[1] * value.y() + m[2] * value.z(),
                    m[3] * value.x() + m[4] * value.y() + m[5] * value.z(),
                    m[6] * value.x() + m[7] * value.y() + m[8] * value.z());
  return drive.is_force ? turned : Vec3(drive.origin + turned);
}

Vec3 value_at(const NetworkDescription& network, const Drive& drive, double time) noexcept {
  CORDIS_ASSERT(is_of_time(network.time_functions[drive.function]));
  return placed(drive, value_at(network.time_functions[drive.function], time));
}

Vec3 force_at(const NetworkDescription& network, const Drive& drive,
              const FunctionPoint& point) noexcept {
  CORDIS_ASSERT(drive.is_force);
  FunctionPoint local = point;
  local.position = turned_back(drive, point.position - drive.origin);
  local.velocity = turned_back(drive, point.velocity);
  return placed(drive, value_at(network.time_functions[drive.function], local));
}

Vec3 start_of(const NetworkDescription& network, const Drive& drive) noexcept {
  return value_at(network, drive, 0.0);
}

bool jumps(const NetworkDescription& network, const Drive& drive, double from, double to,
           const Vec3& before, const Vec3& next) noexcept {
  constexpr int kHalvings = 10;      // a thousandth
  constexpr double kMinWay = 1e-12;  // [m]
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const double whole = (next - before).squaredNorm();
  const double least = std::max(kMinWay, kRounding * std::max(before.norm(), next.norm()));
  if (!(whole > least * least)) return false;
  Vec3 low = before;
  Vec3 high = next;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (from + to);
    const Vec3 there = value_at(network, drive, middle);
    const double way_low = (there - low).squaredNorm();
    const double way_high = (high - there).squaredNorm();
    if (!(std::max(way_low, way_high) > 0.25 * whole)) return false;
    if (way_low > way_high) {
      to = middle;
      high = there;
    } else {
      from = middle;
      low = there;
    }
  }
  return true;
}

void check_time_function(const NetworkDescription& network, const TimeFunction& function,
                         const std::string& name) {
  require(function.time.size() == function.value.size(), name + ": times", "as many as values");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Program& formula = function.formula[axis];
    if (formula.empty()) continue;
    require(function.time.empty(), name, "a table or formulas");
    require(static_cast<int>(axis) < network.dimension, name + ": formula",
            "none beyond the dimension of the network");
    check_program(formula, name + ": formula", network.variables.size());
    require(!has_edge(formula), name + ": formula", "one without rising and falling");
    for (const Instruction& instruction : formula.code) {
      require(instruction.operation != Operation::kQuantity ||
                  is_known_to_functions(instruction.quantity, network.dimension),
              name + ": quantity", "the time, or a place or velocity along an axis of the network");
    }
  }
  for (std::size_t i = 0; i < function.time.size(); ++i) {
    require(std::isfinite(function.time[i]), name + ": time", "finite");
    require(i == 0 || function.time[i] > function.time[i - 1], name + ": time",
            "larger than the one before");
    require(function.value[i].allFinite(), name + ": value", "finite");
    for (int axis = network.dimension; axis < 3; ++axis) {
      require(function.value[i][axis] == 0.0, name + ": value",
              "0 beyond the dimension of the network");
    }
  }
}

void check_drive(const NetworkDescription& network, const Drive& drive, const std::string& name) {
  require(drive.mat < network.mats.size(), name + ": its MAT", "one of the network");
  require(drive.function < network.time_functions.size(), name + ": its function",
          "one of the network");
  const Mat& mat = network.mats[drive.mat];
  require(mat.kind == (drive.is_force ? MatKind::kMass : MatKind::kPort), name + ": its MAT",
          "a port for a position, a mass for a force");
  require(drive.origin.allFinite(), name + ": origin", "finite");
  for (const double value : drive.turn) require(std::isfinite(value), name + ": turn", "finite");
  const TimeFunction& function = network.time_functions[drive.function];
  if (!is_of_time(function)) {
    require(drive.is_force, name + ": its function", "one of time alone for a position");
    require(!asks_for_motion(function) || is_rotation(drive), name + ": turn",
            "a rotation where its function asks for place or velocity");
    if (asks_for_variable(function)) return;  // no values are known yet
  }
  FunctionPoint at_start;
  at_start.position = mat.position;
  at_start.velocity = mat.velocity;
  const Vec3 start = drive.is_force ? force_at(network, drive, at_start) : start_of(network, drive);
  require(start.allFinite(), name + ": value at the start", "finite");
  for (int axis = network.dimension; axis < 3; ++axis) {
    require(start[axis] == 0.0, name + ": value at the start",
            "0 beyond the dimension of the network");
  }
  require(drive.is_force || mat.position == start, name + ": its MAT", "where it begins");
}

}  // namespace cordis::engine
