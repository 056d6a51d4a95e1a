// sim_node/plan/stability/force_field.cpp
#include "sim_node/plan/stability/force_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <optional>
#include <queue>

namespace cordis::plan {
namespace {

using engine::Instruction;
using engine::Operation;
using engine::Program;
using engine::Quantity;
using engine::TimeFunction;
using engine::Vec3;

constexpr double kNoBound = std::numeric_limits<double>::infinity();

Quantity quantity_of(std::size_t coordinate) {
  return coordinate < kAxes ? engine::kPlaceInForce[coordinate]
                            : engine::kVelocityInForce[coordinate - kAxes];
}

/// A coordinate along which the boxes of a search are bisected at even ratios from a millionth on.
double even(double coordinate) {
  return std::asinh(1e6 * coordinate);
}
double middle_of(const Interval& interval) {
  return std::sinh(0.5 * (even(interval.low) + even(interval.high))) / 1e6;
}

/// Writes `u / v^n` as `u * v^-n`, the slopes of which are enclosed nearer; n is a number.
void raise_instead_of_dividing(Program& program) {
  for (std::size_t i = 1; i < program.code.size(); ++i) {
    Instruction& division = program.code[i];
    Instruction& power = program.code[i - 1];
    if (division.operation != Operation::kDivide) continue;
    const bool is_whole = power.operation == Operation::kWholePower;
    const bool is_power = power.operation == Operation::kPower && i > 1 &&
                          program.code[i - 2].operation == Operation::kConstant;
    if (!is_whole && !is_power) continue;
    double& exponent = (is_whole ? power : program.code[i - 2]).constant;
    exponent = -exponent;
    division.operation = Operation::kMultiply;
  }
}

}  // namespace

double largest_of(const Interval& interval) noexcept {
  return std::max(std::abs(interval.low), std::abs(interval.high));
}

ForceField::ForceField(const TimeFunction& function, const std::vector<Interval>& ranges)
    : function_(function) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    for (Instruction& instruction : function_.formula[axis].code) {
      if (instruction.operation == Operation::kVariable) {
        const auto known = std::ranges::find(asked_, instruction.slot);
        const auto number = static_cast<std::uint32_t>(known - asked_.begin());
        if (known == asked_.end()) {
          asked_.push_back(instruction.slot);
          inputs_.push_back(ranges.at(instruction.slot));
        }
        instruction.slot = number;
      } else if (instruction.operation == Operation::kQuantity) {
        for (std::size_t c = 0; c < 2 * kAxes; ++c)
          depends_[axis][c] = depends_[axis][c] || instruction.quantity == quantity_of(c);
      }
    }
  }
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    for (std::size_t c = 0; c < 2 * kAxes; ++c) over_[axis][c] = program_over(axis, c);
  }
}

bool ForceField::asks_for_time() const {
  return std::ranges::any_of(
      function_.formula, [](const Program& formula) { return asks_for(formula, Quantity::kAge); });
}

FoundSlope ForceField::slopes(std::size_t axis, std::size_t coordinate, double extent) const {
  if (!depends_[axis][coordinate]) return {};
  MotionBox whole;
  whole.fill({-extent, extent});
  const Extreme high = most(axis, coordinate, whole, 1.0);
  const Extreme low = most(axis, coordinate, whole, -1.0);
  return {{-low.bound, high.bound}, {-low.reached, high.reached}};
}

Interval ForceField::slope_in(std::size_t axis, std::size_t coordinate,
                              const MotionBox& box) const {
  if (!depends_[axis][coordinate]) return {};
  const ProgramEnclosure found = enclose(over_[axis][coordinate], coordinate, box);
  return coordinate < kAxes ? found.over_distance : found.over_speed;
}

Interval ForceField::value_in(std::size_t axis, const MotionBox& box) const {
  return function_.formula[axis].empty() ? Interval{} : enclose(over_[axis][0], 0, box).value;
}

Vec3 ForceField::at(const Vec3& place) const {
  std::vector<double> variables;
  for (const Interval& range : inputs_) {
    variables.push_back(std::isfinite(largest_of(range)) ? 0.5 * (range.low + range.high) : 1.0);
  }
  return value_at(function_, {1.0, place, Vec3::Zero(), variables.data()});
}

ForceField ForceField::with_held_inputs() const {
  ForceField held = *this;
  held.time_ = {1.0, 1.0};
  for (Interval& range : held.inputs_) {
    if (!std::isfinite(largest_of(range))) range = {1.0, 1.0};
  }
  return held;
}

/// Likewise with time at 1 and all variables at most 1.
ForceField ForceField::with_small_inputs() const {
  ForceField small = *this;
  small.time_ = {1.0, 1.0};
  for (Interval& range : small.inputs_)
    range = {std::clamp(-1.0, range.low, range.high), std::clamp(1.0, range.low, range.high)};
  return small;
}

bool ForceField::has_bounds_near_origin() const {
  MotionBox near;
  near.fill({-1.0, 1.0});
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    for (std::size_t c = 0; c < 2 * kAxes; ++c) {
      if (!std::isfinite(largest_of(slope_in(axis, c, near)))) return false;
    }
  }
  return true;
}

bool ForceField::has_no_bound_by(std::size_t input) const {
  ForceField small = with_small_inputs();
  small.inputs_[input] = inputs_[input];
  return !small.has_bounds_near_origin();
}

bool ForceField::has_no_bound_by_time() const {
  ForceField small = with_small_inputs();
  small.time_ = time_;
  return asks_for_time() && !small.has_bounds_near_origin();
}

std::vector<std::uint64_t> ForceField::content() const {
  std::vector<std::uint64_t> words;
  for (const Program& formula : function_.formula) {
    words.push_back(formula.code.size());
    for (const Instruction& instruction : formula.code) {
      words.push_back(static_cast<std::uint64_t>(instruction.operation));
      words.push_back(static_cast<std::uint64_t>(instruction.quantity));
      words.push_back(std::bit_cast<std::uint64_t>(instruction.constant));
      words.push_back(instruction.slot);
    }
  }
  for (const Interval& range : inputs_) {
    words.push_back(std::bit_cast<std::uint64_t>(range.low));
    words.push_back(std::bit_cast<std::uint64_t>(range.high));
  }
  return words;
}

bool ForceField::depends(std::size_t first) const {
  return std::ranges::any_of(depends_, [first](const auto& of_axis) {
    return std::any_of(of_axis.begin() + static_cast<std::ptrdiff_t>(first),
                       of_axis.begin() + static_cast<std::ptrdiff_t>(first + kAxes),
                       [](bool asked) { return asked; });
  });
}

/// A formula with one coordinate as the distance or the speed of a link, and the others and the time as variables.
Program ForceField::program_over(std::size_t axis, std::size_t coordinate) const {
  Program program = function_.formula[axis];
  raise_instead_of_dividing(program);
  const auto first = static_cast<std::uint32_t>(asked_.size());
  for (Instruction& instruction : program.code) {
    if (instruction.operation != Operation::kQuantity) continue;
    if (instruction.quantity == Quantity::kAge) {
      instruction = {Operation::kVariable, Quantity::kDistance, 0.0,
                     first + static_cast<std::uint32_t>(2 * kAxes)};
      continue;
    }
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

LinkBox ForceField::link_box(std::size_t coordinate, const MotionBox& box) const {
  // Reserved once for all that a search encloses.
  variables_.assign(inputs_.begin(), inputs_.end());
  variables_.insert(variables_.end(), box.begin(), box.end());
  variables_.push_back(time_);
  LinkBox link;
  (coordinate < kAxes ? link.distance : link.speed) = box[coordinate];
  link.variables = &variables_;
  return link;
}

ProgramEnclosure ForceField::enclose(const Program& program, std::size_t coordinate,
                                     const MotionBox& box) const {
  return enclosure_of(program, link_box(coordinate, box));
}

bool ForceField::has_step(double extent) const {
  MotionBox whole;
  whole.fill({-extent, extent});
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    for (std::size_t c = 0; c < 2 * kAxes; ++c) {
      if (depends_[axis][c] && has_step_along(axis, c, whole)) return true;
    }
  }
  return false;
}

/// Bisects the boxes in which a condition may change, the largest first, and looks along a line in each that is left.
bool ForceField::has_step_along(std::size_t axis, std::size_t coordinate,
                                const MotionBox& whole) const {
  constexpr std::size_t kBoxes = 400;
  const Program& program = over_[axis][coordinate];
  std::deque<MotionBox> open{whole};
  for (std::size_t n = 0; n < kBoxes && !open.empty(); ++n) {
    const MotionBox box = open.front();
    open.pop_front();
    if (!is_undecided_or_fails(program, link_box(coordinate, box))) continue;
    const std::size_t longest = longest_axis(axis, box);
    const double middle = middle_of(box[longest]);
    MotionBox lower = box;
    MotionBox upper = box;
    lower[longest].high = upper[longest].low = middle;
    open.push_back(lower);
    open.push_back(upper);
  }
  std::size_t turn = 0;
  return std::ranges::any_of(open, [&](const MotionBox& box) {
    return has_step_on_line_through(program, coordinate, box, turn++);
  });
}

/// The coordinate along which a component depends on the motion and a box is longest.
std::size_t ForceField::longest_axis(std::size_t axis, const MotionBox& box) const {
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t c = 0; c < 2 * kAxes; ++c) {
    const double here = even(box[c].high) - even(box[c].low);
    if (!depends_[axis][c] || !(here > length)) continue;
    longest = c;
    length = here;
  }
  return longest;
}

/// @param turn  chooses the values of what the force asks for
bool ForceField::has_step_on_line_through(const Program& program, std::size_t coordinate,
                                          const MotionBox& box, std::size_t turn) const {
  constexpr std::array kValues{0.5, 1e3, -1.0, 2.0, -1e3};
  LinkBox line = link_box(coordinate, box);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    Interval& range = variables_[i];
    const bool is_of_motion = i >= inputs_.size() && i < inputs_.size() + 2 * kAxes;
    const double value =
        is_of_motion ? middle_of(range)
                     : std::clamp(kValues[(turn + i) % kValues.size()], range.low, range.high);
    range = {value, value};
  }
  return has_step_on_line(program, line, coordinate < kAxes ? &LinkBox::distance : &LinkBox::speed);
}

/// The extreme is that of a slope times a sign; its bound is infinite where none is known. Boxes are bisected where it may
/// be largest.
ForceField::Extreme ForceField::most(std::size_t axis, std::size_t coordinate,
                                     const MotionBox& whole, double sign) const {
  constexpr int kBisections = 1000;
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
    for (std::size_t c = 0; c < 2 * kAxes; ++c) {
      const double middle = middle_of(top.box[c]);
      place[c] = {middle, middle};
    }
    const double here = largest_in(place);
    if (std::isfinite(here)) reached = std::max(reached, here);
    if (top.most <= reached + kNearEnough * std::abs(reached)) break;
    // By turns it is bisected across the longest axis and across the one that leaves the least in the larger half.
    const bool by_length = n % 2 == 1;
    std::optional<std::array<Part, 2>> best;
    double longest = 0.0;
    for (std::size_t c = 0; c < 2 * kAxes; ++c) {
      const double middle = place[c].low;
      if (!depends_[axis][c] || !(middle > top.box[c].low && middle < top.box[c].high)) continue;
      const double length = even(top.box[c].high) - even(top.box[c].low);
      if (by_length && !(length > longest)) continue;
      std::array<Part, 2> halves{top, top};
      halves[0].box[c].high = halves[1].box[c].low = middle;
      for (Part& half : halves) half.most = largest_in(half.box);
      const auto larger = [](const std::array<Part, 2>& pair) {
        return std::max(pair[0].most, pair[1].most);
      };
      const bool is_better = by_length || !best || larger(halves) < larger(*best) ||
                             (larger(halves) == larger(*best) && length > longest);
      if (!is_better) continue;
      best = halves;
      longest = length;
    }
    if (!best) break;
    parts.pop();
    for (const Part& half : *best) parts.push(half);
  }
  return {parts.top().most, reached};
}

}  // namespace cordis::plan
