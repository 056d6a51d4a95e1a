// sim_node/plan/stability/force_slopes.cpp
#include "sim_node/plan/stability/force_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "sim_node/plan/stability/program_enclosure.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {
namespace {

using engine::Instruction;
using engine::Operation;
using engine::Program;
using engine::Quantity;
using engine::TimeFunction;
using engine::VariableKind;
using engine::Vec3;

constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr double kLargestMotion = 1e9;  // [m], [m/s]
constexpr std::size_t kAxes = 3;
constexpr const char* kNoLargest = "no largest slope over all places and velocities is known";

/// Places along the axes [m], then velocities along them [m/s].
using MotionBox = std::array<Interval, 2 * kAxes>;

double largest_of(const Interval& interval) {
  return std::max(std::abs(interval.low), std::abs(interval.high));
}

Quantity quantity_of(std::size_t coordinate) {
  return coordinate < kAxes ? engine::kPlaceInForce[coordinate]
                            : engine::kVelocityInForce[coordinate - kAxes];
}

/// True for a variable that no motion of a mass moves: of time, of states, of where a port or a fixed point is.
bool is_given(const engine::NetworkDescription& network, const engine::Variable& variable) {
  switch (variable.quantity) {
    case VariableKind::kState:
    case VariableKind::kChanges:
    case VariableKind::kAwake:
    case VariableKind::kTime:
    case VariableKind::kAge:
      return true;
    case VariableKind::kPosition:
    case VariableKind::kVelocity:
    case VariableKind::kSpeed:
      return is_of_one_mat(variable) && network.mats[variable.index].kind != engine::MatKind::kMass;
    default:
      return false;
  }
}

std::string word_of(const engine::Variable& variable) {
  switch (variable.quantity) {
    case VariableKind::kTime:
      return "time_s";
    case VariableKind::kPosition:
    case VariableKind::kCenterOfMass:
      return "a position";
    case VariableKind::kVelocity:
    case VariableKind::kSpeed:
    case VariableKind::kElongationRate:
    case VariableKind::kAngularSpeed:
      return "a velocity";
    case VariableKind::kForce:
    case VariableKind::kTension:
    case VariableKind::kContactForce:
    case VariableKind::kMoment:
      return "a force";
    case VariableKind::kDistance:
    case VariableKind::kElongation:
    case VariableKind::kRestLength:
      return "a distance";
    default:
      return is_energy(variable.quantity) ? "an energy" : "a signal";
  }
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

/// A coordinate along which the boxes of a search are bisected at even ratios from a millionth on.
double even(double coordinate) {
  return std::asinh(1e6 * coordinate);
}
double middle_of(const Interval& interval) {
  return std::sinh(0.5 * (even(interval.low) + even(interval.high))) / 1e6;
}

/// The formulas of a force, and what they may meet.
class ForceField {
 public:
  ForceField(const engine::NetworkDescription& network, const TimeFunction& function)
      : network_(network), function_(function) {
    for (const engine::Variable& variable : network.variables)
      ranges_.push_back(range_of_variable(network, variable));
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      for (const Instruction& instruction : function.formula[axis].code) {
        if (instruction.operation == Operation::kVariable) {
          asked_.resize(network.variables.size());
          asked_[instruction.slot] = true;
        } else if (instruction.operation == Operation::kQuantity) {
          for (std::size_t c = 0; c < 2 * kAxes; ++c)
            depends_[axis][c] = depends_[axis][c] || instruction.quantity == quantity_of(c);
        }
      }
      for (std::size_t c = 0; c < 2 * kAxes; ++c) over_[axis][c] = program_over(axis, c);
    }
  }

  bool depends_on_place() const { return depends(0); }
  bool depends_on_velocity() const { return depends(kAxes); }

  /// What all slopes of a component over a coordinate lie within, at places and velocities up to an extent.
  Interval slopes(std::size_t axis, std::size_t coordinate, double extent) const {
    if (!depends_[axis][coordinate]) return {};
    MotionBox whole;
    whole.fill({-extent, extent});
    const double high = most(axis, coordinate, whole, 1.0);
    const double low = -most(axis, coordinate, whole, -1.0);
    return {low, high};
  }

  Interval slope_in(std::size_t axis, std::size_t coordinate, const MotionBox& box) const {
    if (!depends_[axis][coordinate]) return {};
    const ProgramEnclosure found = enclose(over_[axis][coordinate], coordinate, box);
    return coordinate < kAxes ? found.over_distance : found.over_speed;
  }

  Interval value_in(std::size_t axis, const MotionBox& box) const {
    return function_.formula[axis].empty() ? Interval{} : enclose(over_[axis][0], 0, box).value;
  }

  /// What it asks for and has no end, by names; `is_counted` says which variables.
  template <class IsCounted>
  std::vector<std::string> unbounded_inputs(IsCounted is_counted) const {
    std::vector<std::string> words;
    const auto add = [&words](const std::string& word) {
      if (std::ranges::find(words, word) == words.end()) words.push_back(word);
    };
    for (std::size_t v = 0; v < asked_.size(); ++v) {
      if (asked_[v] && is_counted(network_.variables[v], ranges_[v]))
        add(word_of(network_.variables[v]));
    }
    return words;
  }
  bool asks_for_time() const {
    return std::ranges::any_of(function_.formula, [](const Program& formula) {
      return asks_for(formula, Quantity::kAge);
    });
  }

  /// Holds time and the variables without an end at 1 from here on.
  void hold_inputs() {
    time_ = {1.0, 1.0};
    for (Interval& range : ranges_) {
      if (!std::isfinite(largest_of(range))) range = {1.0, 1.0};
    }
  }

  /// The force at a place at rest, at a time and with what it asks for in the middle of its range [N].
  Vec3 at(const Vec3& place) const {
    std::vector<double> variables;
    for (const Interval& range : ranges_) {
      variables.push_back(std::isfinite(largest_of(range)) ? 0.5 * (range.low + range.high) : 1.0);
    }
    return value_at(function_, {1.0, place, Vec3::Zero(), variables.data()});
  }

 private:
  static constexpr int kBisections = 1000;

  bool depends(std::size_t first) const {
    return std::ranges::any_of(depends_, [first](const auto& of_axis) {
      return std::any_of(of_axis.begin() + static_cast<std::ptrdiff_t>(first),
                         of_axis.begin() + static_cast<std::ptrdiff_t>(first + kAxes),
                         [](bool asked) { return asked; });
    });
  }

  /// A formula with one coordinate as the distance or the speed of a link, and the others as variables.
  Program program_over(std::size_t axis, std::size_t coordinate) const {
    Program program = function_.formula[axis];
    const auto first = static_cast<std::uint32_t>(network_.variables.size());
    for (Instruction& instruction : program.code) {
      if (instruction.operation != Operation::kQuantity) continue;
      for (std::uint32_t c = 0; c < 2 * kAxes; ++c) {
        if (instruction.quantity != quantity_of(c)) continue;
        if (c == coordinate) {
          instruction.quantity = c < kAxes ? Quantity::kDistance : Quantity::kSpeed;
        } else {
          instruction = {Operation::kVariable, Quantity::kDistance, 0.0, first + c};
        }
        break;
      }
    }
    return program;
  }

  ProgramEnclosure enclose(const Program& program, std::size_t coordinate,
                           const MotionBox& box) const {
    std::vector<Interval> variables = ranges_;
    variables.insert(variables.end(), box.begin(), box.end());
    LinkBox link;
    (coordinate < kAxes ? link.distance : link.speed) = box[coordinate];
    link.remembered = time_;
    link.variables = &variables;
    return enclosure_of(program, link);
  }

  /// The largest of a slope times a sign; infinite where none is known.
  double most(std::size_t axis, std::size_t coordinate, const MotionBox& whole, double sign) const {
    constexpr double kNearEnough = 0.02;
    struct Part {
      MotionBox box;
      double most;
      bool operator<(const Part& other) const { return most < other.most; }
    };
    const auto largest_in = [&](const MotionBox& box) {
      const Interval slope = slope_in(axis, coordinate, box);
      return sign > 0.0 ? slope.high : -slope.low;
    };
    std::priority_queue<Part> parts;
    parts.push({whole, largest_in(whole)});
    double reached = -kNoBound;
    for (int n = 0; n < kBisections; ++n) {
      const Part top = parts.top();
      MotionBox place;
      std::size_t widest = 0;
      double width = -1.0;
      for (std::size_t c = 0; c < 2 * kAxes; ++c) {
        const double middle = middle_of(top.box[c]);
        place[c] = {middle, middle};
        const double here = even(top.box[c].high) - even(top.box[c].low);
        if (!depends_[axis][c] || !(here > width)) continue;
        width = here;
        widest = c;
      }
      const double here = largest_in(place);
      if (std::isfinite(here)) reached = std::max(reached, here);
      if (top.most <= reached + kNearEnough * std::abs(reached)) break;
      const double middle = place[widest].low;
      if (!(middle > top.box[widest].low && middle < top.box[widest].high)) break;
      parts.pop();
      MotionBox lower = top.box;
      MotionBox upper = top.box;
      lower[widest].high = upper[widest].low = middle;
      parts.push({lower, largest_in(lower)});
      parts.push({upper, largest_in(upper)});
    }
    return parts.top().most;
  }

  const engine::NetworkDescription& network_;
  const TimeFunction& function_;
  std::vector<Interval> ranges_;  // of the variables of the network
  Interval time_{0.0, kNoBound};  // [s]
  std::vector<bool> asked_;       // by variable; empty: none is
  std::array<std::array<bool, 2 * kAxes>, kAxes> depends_{};
  std::array<std::array<Program, 2 * kAxes>, kAxes> over_;
};

/// All slopes of a force over the places or over the velocities.
using Slopes = std::array<std::array<Interval, kAxes>, kAxes>;

Slopes slopes_over(const ForceField& field, std::size_t first, double extent = kLargestMotion) {
  Slopes slopes;
  for (std::size_t i = 0; i < kAxes; ++i) {
    for (std::size_t j = 0; j < kAxes; ++j) slopes[i][j] = field.slopes(i, first + j, extent);
  }
  return slopes;
}

bool is_finite(const Slopes& slopes) {
  for (const auto& row : slopes) {
    for (const Interval& slope : row) {
      if (!std::isfinite(largest_of(slope))) return false;
    }
  }
  return true;
}

/// The sum of all sizes.
double size_of_slopes(const Slopes& slopes) {
  double sum = 0.0;
  for (const auto& row : slopes) {
    for (const Interval& slope : row) sum += largest_of(slope);
  }
  return sum;
}

/// True if slopes go on growing far away, so that they have no bound.
bool grows(const ForceField& field, std::size_t first, const Slopes& slopes) {
  constexpr double kNearer = 1e-3;
  constexpr double kSame = 1.05;
  return size_of_slopes(slopes) >
         kSame * size_of_slopes(slopes_over(field, first, kNearer * kLargestMotion));
}

/// No eigenvalue of what opposes is larger [Gershgorin].
double opposing(const Slopes& slopes) {
  double most = 0.0;
  for (std::size_t i = 0; i < kAxes; ++i) {
    double sum = std::max(0.0, -slopes[i][i].low);
    for (std::size_t j = 0; j < kAxes; ++j) sum += i == j ? 0.0 : largest_of(slopes[i][j]);
    most = std::max(most, sum);
  }
  return most;
}

double variation_of_slopes(const Slopes& slopes) {
  double most = 0.0;
  for (const auto& row : slopes) {
    double sum = 0.0;
    for (const Interval& slope : row) sum += slope.high - slope.low;
    most = std::max(most, sum);
  }
  return most;
}

/// True if it surely opposes each component of the velocity by itself.
bool only_opposes(const Slopes& slopes) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    for (std::size_t j = 0; j < kAxes; ++j) {
      if (i == j ? slopes[i][j].high > 0.0 : largest_of(slopes[i][j]) > 0.0) return false;
    }
  }
  return true;
}

/// True if the slopes at some places show that it has no potential.
bool works_on_closed_ways(const ForceField& field) {
  constexpr int kPlaces = 300;
  constexpr double kGolden = 0.618033988749894848;
  constexpr double kRounding = 1e-6;
  for (int n = 1; n <= kPlaces; ++n) {
    MotionBox place{};
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double turn = kGolden * n * static_cast<double>(axis + 1);
      const double share = 2.0 * (turn - std::floor(turn)) - 1.0;
      const double there = share * std::pow(10.0, n % 5 - 2);
      place[axis] = {there, there};
    }
    for (std::size_t i = 0; i < kAxes; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Interval one = field.slope_in(i, j, place);
        const Interval other = field.slope_in(j, i, place);
        const double size = largest_of(one) + largest_of(other);
        if (!std::isfinite(size)) continue;
        if (std::max(one.low - other.high, other.low - one.high) > kRounding * size) return true;
      }
    }
  }
  return false;
}

/// True if it drives a MAT away with a force that grows with the distance.
bool drives_away(const ForceField& field, int dimension) {
  constexpr double kNear = 1e2;  // [m]
  constexpr double kFar = 1e3;
  const int side_of_z = dimension > 2 ? 1 : 0;
  const int side_of_y = dimension > 1 ? 1 : 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -side_of_y; y <= side_of_y; ++y) {
      for (int z = -side_of_z; z <= side_of_z; ++z) {
        const Vec3 way(x, y, z);
        if (way.isZero(0.0)) continue;
        const double near = field.at(kNear * way.normalized()).dot(way);
        const double far = field.at(kFar * way.normalized()).dot(way);
        if (near > 0.0 && far > 2.0 * near) return true;
      }
    }
  }
  return false;
}

/// True if it is 0 at every place where the MAT is at rest.
bool is_none_at_rest(const ForceField& field) {
  MotionBox at_rest;
  at_rest.fill({});
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    at_rest[axis] = {-kLargestMotion, kLargestMotion};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if (largest_of(field.value_in(axis, at_rest)) != 0.0) return false;
  }
  return true;
}

/// Why a slope has no bound.
std::string without_bound(ForceField field) {
  std::vector<std::string> words =
      field.unbounded_inputs([](const engine::Variable&, const Interval& range) {
        return !std::isfinite(largest_of(range));
      });
  if (field.asks_for_time() && std::ranges::find(words, "time_s") == words.end())
    words.insert(words.begin(), "time_s");
  field.hold_inputs();
  const bool inputs_alone =
      is_finite(slopes_over(field, 0)) && is_finite(slopes_over(field, kAxes));
  if (!words.empty() && inputs_alone)
    return "it asks for " + list_of(words) + ", which nothing bounds";
  return kNoLargest;
}

}  // namespace

ForceSlopes slopes_of_force(const engine::NetworkDescription& network,
                            const TimeFunction& function) {
  ForceSlopes found;
  if (is_of_time(function)) return found;
  const ForceField field(network, function);
  const bool is_drag = field.depends_on_velocity() && is_none_at_rest(field);
  found.brings_energy = !is_drag;
  const Slopes over_place = slopes_over(field, 0);
  const Slopes over_velocity = slopes_over(field, kAxes);
  if (!is_finite(over_place) || !is_finite(over_velocity)) {
    found.uncertainty = without_bound(field);
    return found;
  }
  if (grows(field, 0, over_place) || grows(field, kAxes, over_velocity)) {
    found.uncertainty = kNoLargest;
    return found;
  }
  found.stiffness = opposing(over_place);
  found.viscosity = opposing(over_velocity);
  found.variation = variation_of_slopes(over_place);
  const std::vector<std::string> moving =
      field.unbounded_inputs([&](const engine::Variable& variable, const Interval& range) {
        return !is_given(network, variable) && range.low != range.high;
      });
  if (!only_opposes(over_velocity)) {
    found.uncertainty = "it may drive what moves, and nothing bounds the energy of that";
  } else if (!is_drag && !moving.empty()) {
    found.uncertainty =
        "it asks for " + list_of(moving) + ", and nothing bounds what that brings in";
  } else if (field.depends_on_place() && works_on_closed_ways(field)) {
    found.uncertainty = "it does work on closed ways, and nothing bounds the energy of that";
  } else if (field.depends_on_place() && drives_away(field, network.dimension)) {
    found.uncertainty = "it drives its MAT away ever harder";
  }
  return found;
}

}  // namespace cordis::plan
