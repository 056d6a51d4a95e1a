// sim_node/plan/stability/program_enclosure.cpp
#include "sim_node/plan/stability/program_enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "node/assert.h"
#include "sim_node/engine/laws/expression.h"

namespace cordis::plan {
namespace {

using engine::Instruction;
using engine::Operation;
using engine::Quantity;

constexpr Interval kAny = kAnyNumber;
constexpr std::size_t kVariables = 2;                                           // distance, speed
constexpr std::size_t kAnyVariables = std::numeric_limits<std::size_t>::max();  // of the network

double size_of(const Interval& u) {
  return std::max(std::abs(u.low), std::abs(u.high));
}
bool holds_zero(const Interval& u) {
  return u.low <= 0.0 && u.high >= 0.0;
}
bool is_point(const Interval& u) {
  return u.low == u.high;
}
Interval checked(double low, double high) {
  return std::isnan(low) || std::isnan(high) ? kAny : Interval{low, high};
}
Interval hull(const Interval& u, const Interval& v) {
  return {std::min(u.low, v.low), std::max(u.high, v.high)};
}
Interval operator+(const Interval& u, const Interval& v) {
  return checked(u.low + v.low, u.high + v.high);
}
Interval operator-(const Interval& u) {
  return {-u.high, -u.low};
}
Interval operator-(const Interval& u, const Interval& v) {
  return u + -v;
}
/// Ends that are infinite stand for numbers without a bound: 0 times them is 0.
double product(double u, double v) {
  return u == 0.0 || v == 0.0 ? 0.0 : u * v;
}
Interval operator*(const Interval& u, const Interval& v) {
  const auto [low, high] = std::minmax({product(u.low, v.low), product(u.low, v.high),
                                        product(u.high, v.low), product(u.high, v.high)});
  return checked(low, high);
}
/// Precondition: it does not hold 0.
Interval inverse(const Interval& u) {
  CORDIS_ASSERT(!holds_zero(u));
  return {1.0 / u.high, 1.0 / u.low};
}

/// Value and derivatives in a box.
struct Enclosed {
  Interval value;
  std::array<Interval, kVariables> slope{};
  bool jumps = false;  // a truth or a sign that is not decided in the box
  bool fails = false;  // a part of it may be no finite number, and then the whole counts as 0
  bool moves = false;  // it asks for the distance or the speed
};

const Enclosed kUnknown{kAny, {kAny, kAny}};
const Enclosed kFailing{kAny, {kAny, kAny}, false, true};

/// f of u, with what f' lies within.
Enclosed chain(const Enclosed& u, const Interval& value, const Interval& derivative) {
  Enclosed f{value};
  for (std::size_t i = 0; i < kVariables; ++i) f.slope[i] = derivative * u.slope[i];
  return f;
}

Interval whole_power(const Interval& u, int exponent) {
  const double low = std::pow(u.low, exponent);
  const double high = std::pow(u.high, exponent);
  if (exponent % 2 == 0 && holds_zero(u)) return checked(0.0, std::max(low, high));
  return checked(std::min(low, high), std::max(low, high));
}

/// The values of a function with |f'| <= 1 and |f| <= 1.
template <class Function>
Interval of_wave(const Interval& u, Function f) {
  const double half = 0.5 * (u.high - u.low);
  if (!(half < 2.0)) return {-1.0, 1.0};
  const double middle = f(u.low + half);
  return {std::max(-1.0, middle - half), std::min(1.0, middle + half)};
}

class Evaluation {
 public:
  explicit Evaluation(const LinkBox& box) : box_(box) {}

  Enclosed enclose(const engine::Program& program) {
    std::vector<Enclosed> stack;
    stack.reserve(engine::kMaxStack);
    for (const Instruction& instruction : program.code) {
      const std::size_t taken = engine::operand_count(instruction.operation);
      const Enclosed result = result_of(instruction, stack.data() + (stack.size() - taken), taken);
      stack.resize(stack.size() - taken);
      stack.push_back(result);
    }
    const Enclosed& whole = stack.front();
    fails_ = whole.fails;
    return whole.jumps || whole.fails ? Enclosed{whole.value, {kAny, kAny}} : whole;
  }
  /// True if it was not decided in the box which of two values is taken.
  bool is_undecided() const { return is_undecided_; }
  /// True if the value may be no finite number somewhere in the box.
  bool fails() const { return fails_; }

 private:
  /// What an instruction makes of its operands, and how it follows the link.
  Enclosed result_of(const Instruction& instruction, const Enclosed* operands, std::size_t taken) {
    Enclosed f = apply(instruction, operands);
    const bool is_quantity = instruction.operation == Operation::kQuantity;
    f.moves = is_quantity ? is_of_motion(instruction.quantity)
                          : std::any_of(operands, operands + taken,
                                        [](const Enclosed& operand) { return operand.moves; });
    if (!f.moves) {  // whatever the variables are, it is one number over the box
      f.slope = {};
      f.jumps = false;
    }
    if (f.jumps || f.fails || std::isfinite(size_of(f.value)) || !box_is_finite()) return f;
    const bool has_no_number = (std::isinf(f.value.low) && f.value.low > 0.0) ||
                               (std::isinf(f.value.high) && f.value.high < 0.0);
    if (is_of_variables_alone(f) && !has_no_number) return f;
    const bool moves = f.moves;
    f = has_no_number || (moves && !is_quantity) ? kFailing : kUnknown;
    f.moves = moves;
    if (!moves) f.slope = {};
    return f;
  }

  bool is_of_motion(Quantity which) const {
    switch (which) {
      case Quantity::kDistance:
      case Quantity::kElongation:
      case Quantity::kSpeed:
        return true;
      case Quantity::kRestLength:
        return box_.rest_moves;
      default:
        return false;
    }
  }

  bool box_is_finite() const {
    return std::isfinite(size_of(box_.distance)) && std::isfinite(size_of(box_.speed));
  }

  /// Variables have no ends that a box could give them.
  bool is_of_variables_alone(const Enclosed& u) const {
    return box_.variables != nullptr && std::ranges::all_of(u.slope, [](const Interval& slope) {
             return size_of(slope) == 0.0;
           });
  }

  Enclosed quantity(Quantity which) const {
    const Interval one{1.0, 1.0};
    switch (which) {
      case Quantity::kDistance:
        return {box_.distance, {one, {}}};
      case Quantity::kElongation:
        if (box_.rest_moves) return {box_.distance - box_.moved_rest, kUnknown.slope};
        return {box_.distance - Interval{box_.rest_length, box_.rest_length}, {one, {}}};
      case Quantity::kSpeed:
        return {box_.speed, {Interval{}, one}};
      case Quantity::kMassA:
        return {box_.mass_a};
      case Quantity::kMassB:
        return {box_.mass_b};
      case Quantity::kForce:
        return {box_.force};
      case Quantity::kAge:
      case Quantity::kImpulse:
      case Quantity::kSlid:
        return {box_.remembered};
      case Quantity::kRestLength:
        if (box_.rest_moves) return {box_.moved_rest, kUnknown.slope};
        return {{box_.rest_length, box_.rest_length}};
      default:
        return kUnknown;
    }
  }

  /// How much a value may change within the box, with some to spare.
  double change_of(const Enclosed& u) const {
    constexpr double kSpare = 4.0;
    return kSpare * (product(box_.distance.high - box_.distance.low, size_of(u.slope[0])) +
                     product(box_.speed.high - box_.speed.low, size_of(u.slope[1])));
  }

  /// One of two in a box in which it is not decided which: as steep as either where they meet, for
  /// what is no more apart than its slopes make it.
  Enclosed either(const Enclosed& u, const Enclosed& v) {
    Enclosed both{hull(u.value, v.value)};
    const double apart = size_of(u.value - v.value);
    const bool meet = apart <= change_of(u) + change_of(v);
    is_undecided_ = true;
    for (std::size_t i = 0; i < kVariables; ++i) {
      both.slope[i] = meet ? hull(u.slope[i], v.slope[i]) : kAny;
    }
    return both;
  }

  /// One of two, the same in all of the box: variables alone choose.
  static Enclosed one_throughout(const Enclosed& u, const Enclosed& v) {
    return joined(u, v, hull(u.value, v.value));
  }

  Enclosed multiply(const Enclosed& u, const Enclosed& v) {
    if (u.jumps && v.jumps) return {u.value * v.value, {}, true};
    if (v.jumps) return multiply(v, u);
    if (u.jumps) {
      const Enclosed at_low = chain(v, Interval{u.value.low, u.value.low} * v.value,
                                    Interval{u.value.low, u.value.low});
      const Enclosed at_high = chain(v, Interval{u.value.high, u.value.high} * v.value,
                                     Interval{u.value.high, u.value.high});
      return either(at_low, at_high);
    }
    Enclosed f{u.value * v.value};
    for (std::size_t i = 0; i < kVariables; ++i) {
      f.slope[i] = u.value * v.slope[i] + u.slope[i] * v.value;
    }
    return f;
  }

  /// A truth of what may be no number: nothing is certain of it.
  static Enclosed failing_truth() { return {{0.0, 1.0}, {}, true, true}; }

  static Enclosed truth(bool certainly, bool certainly_not) {
    if (certainly) return {{1.0, 1.0}};
    if (certainly_not) return {{0.0, 0.0}};
    return {{0.0, 1.0}, {}, true};
  }

  static Enclosed power(const Enclosed& u, const Enclosed& v) {
    const double n = v.value.low;
    if (!is_point(v.value) || u.value.low < 0.0) return kFailing;
    if (n == 0.0) return {{1.0, 1.0}};
    const auto power_of_u = [&](double exponent) {
      const double low = std::pow(u.value.low, exponent);
      const double high = std::pow(u.value.high, exponent);
      return checked(std::min(low, high), std::max(low, high));
    };
    return chain(u, power_of_u(n), Interval{n, n} * power_of_u(n - 1.0));
  }

  /// True if a function of one finite number may be none, but for overflow.
  static bool may_fail(Operation operation) {
    return operation == Operation::kSqrt || operation == Operation::kLog ||
           operation == Operation::kWholePower;
  }

  Enclosed one(const Instruction& instruction, const Enclosed& u) const {
    const Interval& x = u.value;
    if (u.fails) return instruction.operation == Operation::kNot ? failing_truth() : kFailing;
    switch (instruction.operation) {
      case Operation::kNegate: {
        Enclosed f = chain(u, -x, {-1.0, -1.0});
        f.jumps = u.jumps;
        return f;
      }
      case Operation::kNot:
        return truth(x.low == 0.0 && x.high == 0.0, x.low > 0.0 || x.high < 0.0);
      default:
        break;
    }
    if (u.jumps) return may_fail(instruction.operation) ? kFailing : kUnknown;
    switch (instruction.operation) {
      case Operation::kAbs:
        if (x.low >= 0.0) return u;
        if (x.high <= 0.0) return chain(u, -x, {-1.0, -1.0});
        return chain(u, {0.0, size_of(x)}, {-1.0, 1.0});
      case Operation::kSqrt:
        if (x.low < 0.0) return kFailing;
        return chain(u, {std::sqrt(x.low), std::sqrt(x.high)},
                     {0.5 / std::sqrt(x.high), 0.5 / std::sqrt(std::abs(x.low))});  // of -0 as well
      case Operation::kSign:
        if (x.low > 0.0) return {{1.0, 1.0}};
        if (x.high < 0.0) return {{-1.0, -1.0}};
        return {{-1.0, 1.0}, {}, true};
      case Operation::kExp: {
        const Interval e{std::exp(x.low), std::exp(x.high)};
        return chain(u, e, e);
      }
      case Operation::kLog:
        if (x.low <= 0.0) return kFailing;
        return chain(u, {std::log(x.low), std::log(x.high)}, inverse(x));
      case Operation::kSin:
        return chain(u, of_wave(x, [](double v) { return std::sin(v); }),
                     of_wave(x, [](double v) { return std::cos(v); }));
      case Operation::kCos:
        return chain(u, of_wave(x, [](double v) { return std::cos(v); }),
                     of_wave(x, [](double v) { return -std::sin(v); }));
      case Operation::kTanh: {
        const Interval t{std::tanh(x.low), std::tanh(x.high)};
        const Interval square = whole_power(t, 2);
        return chain(u, t, {1.0 - square.high, 1.0 - square.low});
      }
      case Operation::kWholePower: {
        const int n = static_cast<int>(instruction.constant);
        if (n == 0) return {{1.0, 1.0}};
        if (n < 0 && holds_zero(x)) return kFailing;
        const double factor = n;
        return chain(u, whole_power(x, n), Interval{factor, factor} * whole_power(x, n - 1));
      }
      default:
        return kUnknown;  // rising and falling, of which no law is made
    }
  }

  Enclosed apply(const Instruction& instruction, const Enclosed* operands) {
    const std::size_t count = engine::operand_count(instruction.operation);
    if (instruction.operation == Operation::kConstant) {
      return {{instruction.constant, instruction.constant}};
    }
    if (instruction.operation == Operation::kQuantity) return quantity(instruction.quantity);
    if (instruction.operation == Operation::kVariable) {
      return {box_.variables == nullptr ? kAny : box_.variables->at(instruction.slot)};
    }
    if (count == 1) return one(instruction, operands[0]);
    if (instruction.operation == Operation::kSelect) {
      const Interval& which = operands[0].value;
      if (operands[0].fails) return kFailing;
      if (!holds_zero(which)) return operands[1];
      if (is_point(which)) return operands[2];
      if (operands[1].fails || operands[2].fails) return kFailing;
      if (operands[1].jumps || operands[2].jumps) return kUnknown;
      return operands[0].moves ? either(operands[1], operands[2])
                               : one_throughout(operands[1], operands[2]);
    }
    return two(instruction.operation, operands[0], operands[1]);
  }

  static bool is_truth(Operation operation) {
    return operation >= Operation::kLess && operation <= Operation::kOr;
  }

  Enclosed two(Operation operation, const Enclosed& u, const Enclosed& v) {
    const Interval& x = u.value;
    const Interval& y = v.value;
    const bool x_is_true = !u.fails && !holds_zero(x);
    const bool y_is_true = !v.fails && !holds_zero(y);
    const bool x_is_false = !u.fails && holds_zero(x) && is_point(x);
    const bool y_is_false = !v.fails && holds_zero(y) && is_point(y);
    if (u.fails || v.fails) {
      if (operation == Operation::kAnd && (x_is_false || y_is_false)) return truth(false, true);
      if (operation == Operation::kOr && (x_is_true || y_is_true)) return truth(true, false);
      return is_truth(operation) ? failing_truth() : kFailing;
    }
    switch (operation) {
      case Operation::kLess:
        return truth(x.high < y.low, x.low >= y.high);
      case Operation::kLessOrEqual:
        return truth(x.high <= y.low, x.low > y.high);
      case Operation::kGreater:
        return truth(x.low > y.high, x.high <= y.low);
      case Operation::kGreaterOrEqual:
        return truth(x.low >= y.high, x.high < y.low);
      case Operation::kEqual:
        return truth(is_point(x) && is_point(y) && x.low == y.low,
                     x.high < y.low || x.low > y.high);
      case Operation::kNotEqual:
        return truth(x.high < y.low || x.low > y.high,
                     is_point(x) && is_point(y) && x.low == y.low);
      case Operation::kAnd:
        return truth(x_is_true && y_is_true, x_is_false || y_is_false);
      case Operation::kOr:
        return truth(x_is_true || y_is_true, x_is_false && y_is_false);
      case Operation::kMultiply:
        return multiply(u, v);
      default:
        break;
    }
    if (u.jumps || v.jumps) {
      const bool may_fail = operation == Operation::kDivide || operation == Operation::kPower;
      return may_fail ? kFailing : kUnknown;
    }
    switch (operation) {
      case Operation::kMin:
        if (x.high <= y.low) return u;
        if (y.high <= x.low) return v;
        return joined(u, v, {std::min(x.low, y.low), std::min(x.high, y.high)});
      case Operation::kMax:
        if (x.low >= y.high) return u;
        if (y.low >= x.high) return v;
        return joined(u, v, {std::max(x.low, y.low), std::max(x.high, y.high)});
      case Operation::kAdd:
        return {x + y, {u.slope[0] + v.slope[0], u.slope[1] + v.slope[1]}};
      case Operation::kSubtract:
        return {x - y, {u.slope[0] - v.slope[0], u.slope[1] - v.slope[1]}};
      case Operation::kDivide: {
        if (holds_zero(y)) return kFailing;
        const Interval part = inverse(y);
        return multiply(u, chain(v, part, -(part * part)));
      }
      case Operation::kPower:
        return power(u, v);
      default:
        return kUnknown;
    }
  }

  static Enclosed joined(const Enclosed& u, const Enclosed& v, const Interval& value) {
    return {value, {hull(u.slope[0], v.slope[0]), hull(u.slope[1], v.slope[1])}};
  }

  const LinkBox& box_;
  bool is_undecided_ = false;
  bool fails_ = false;
};

/// The largest of one slope over the box, or of what is read off it.
/// @param read    a number of the interval of a slope, and no less for a wider one
/// @param enough  of a bound, and of what is reached at places: near enough to end the search
template <class Read, class Enough>
double steepest(const engine::Program& program, const LinkBox& whole, std::size_t variable,
                const Read& read, const Enough& enough, int bisections) {
  struct SubBox {
    LinkBox box;
    double most;
    bool operator<(const SubBox& other) const { return most < other.most; }
  };
  const auto largest_in = [&](const LinkBox& box) {
    return read(Evaluation(box).enclose(program).slope[variable]);
  };
  const auto sub_box = [&](const LinkBox& box) { return SubBox{box, largest_in(box)}; };
  std::priority_queue<SubBox> boxes;
  boxes.push(sub_box(whole));
  double reached = -std::numeric_limits<double>::infinity();  // at places: no bound is below it
  const double distance = whole.distance.high - whole.distance.low;
  const double speed = whole.speed.high - whole.speed.low;
  for (int n = 0; n < bisections && !enough(boxes.top().most, reached); ++n) {
    SubBox top = boxes.top();
    LinkBox place = top.box;
    place.distance.low = place.distance.high = 0.5 * (top.box.distance.low + top.box.distance.high);
    place.speed.low = place.speed.high = 0.5 * (top.box.speed.low + top.box.speed.high);
    const double here = largest_in(place);
    if (std::isfinite(here)) reached = std::max(reached, here);
    const bool over_distance = (top.box.distance.high - top.box.distance.low) * speed >=
                               (top.box.speed.high - top.box.speed.low) * distance;
    const Interval& wide = over_distance ? top.box.distance : top.box.speed;
    const double middle = 0.5 * (wide.low + wide.high);
    if (!(middle > wide.low && middle < wide.high)) break;
    boxes.pop();
    LinkBox lower = top.box;
    LinkBox upper = top.box;
    (over_distance ? lower.distance : lower.speed).high = middle;
    (over_distance ? upper.distance : upper.speed).low = middle;
    boxes.push(sub_box(lower));
    boxes.push(sub_box(upper));
  }
  return boxes.top().most;
}

constexpr double kNearEnough = 0.02;

double extent_of(const Interval& interval) {
  return interval.high - interval.low;
}

/// Looks along a variable for a place where a program steps from one value to another.
class StepSearch {
 public:
  /// @param smallest   what is left of the way where the two values are compared
  /// @param variables  values of the variables of the network; those of the box are the same
  StepSearch(const engine::Program& program, Interval LinkBox::*variable, double smallest,
             const std::vector<double>& variables)
      : program_(program),
        variable_(variable),
        slope_(variable == &LinkBox::distance ? 0 : 1),
        smallest_(smallest),
        variables_(variables) {}

  /// @param line  all but the variable are points
  bool finds_in(LinkBox line) const {
    constexpr int kMaxIterations = 400;
    std::vector<Interval> parts{line.*variable_};
    for (int iteration = 0; iteration < kMaxIterations && !parts.empty(); ++iteration) {
      const Interval part = parts.back();
      parts.pop_back();
      line.*variable_ = part;
      Evaluation evaluation(line);
      evaluation.enclose(program_);
      if (!evaluation.is_undecided()) continue;
      const double middle = 0.5 * (part.low + part.high);
      if (extent_of(part) > smallest_ && middle > part.low && middle < part.high) {
        parts.push_back({middle, part.high});
        parts.push_back({part.low, middle});
      } else if (steps_between_the_ends_of(line)) {
        return true;
      }
    }
    return false;
  }

  /// True if a value ends in a step where no finite number follows, between two of some places.
  bool finds_end_in(const LinkBox& line, int places) const {
    const Interval& way = line.*variable_;
    const auto place = [&](int n) { return way.low + extent_of(way) * n / places; };
    bool was_finite = is_finite_at(line, way.low);
    for (int n = 1; n <= places; ++n) {
      const bool is_finite = is_finite_at(line, place(n));
      if (is_finite != was_finite && ends_in_a_step(line, {place(n - 1), place(n)}, was_finite))
        return true;
      was_finite = is_finite;
    }
    return false;
  }

 private:
  /// The value and the slope at a place.
  struct Place {
    double value;  // 0 for what is no finite number
    double slope;  // 0 where a condition just changes, or a part is no finite number
  };
  double value_at(const LinkBox& line, double place) const {
    engine::LinkQuantities now{};
    const double distance = variable_ == &LinkBox::distance ? place : line.distance.low;
    const double speed = variable_ == &LinkBox::speed ? place : line.speed.low;
    now[static_cast<std::size_t>(Quantity::kDistance)] = distance;
    now[static_cast<std::size_t>(Quantity::kElongation)] = distance - line.rest_length;
    now[static_cast<std::size_t>(Quantity::kSpeed)] = speed;
    now[static_cast<std::size_t>(Quantity::kMassA)] = line.mass_a.low;
    now[static_cast<std::size_t>(Quantity::kMassB)] = line.mass_b.low;
    now[static_cast<std::size_t>(Quantity::kRestLength)] = line.rest_length;
    return engine::value_of(program_, now, nullptr, 0.0, variables_.data());
  }
  bool is_finite_at(const LinkBox& line, double place) const {
    return std::isfinite(value_at(line, place));
  }
  Place at(LinkBox line, double place) const {
    const double value = value_at(line, place);
    if (!std::isfinite(value)) return {0.0, 0.0};
    line.*variable_ = {place, place};
    Evaluation evaluation(line);
    const Enclosed here = evaluation.enclose(program_);
    const bool is_known = !evaluation.is_undecided() && !evaluation.fails();
    return {value, is_known ? size_of(here.slope[slope_]) : 0.0};
  }
  /// True if the values at both ends are farther apart than the slopes there make them.
  bool steps_between_the_ends_of(const LinkBox& line) const {
    constexpr double kSpare = 4.0;
    constexpr double kRounding = 1e-12;
    const Interval& way = line.*variable_;
    const Place low = at(line, way.low);
    const Place high = at(line, way.high);
    const double change = kSpare * (low.slope + high.slope) * extent_of(way) +
                          kRounding * (std::abs(low.value) + std::abs(high.value));
    return std::abs(high.value - low.value) > change;
  }
  /// @param part  one end alone is finite
  bool ends_in_a_step(LinkBox line, Interval part, bool low_is_finite) const {
    while (extent_of(part) > smallest_) {
      const double middle = 0.5 * (part.low + part.high);
      if (!(middle > part.low && middle < part.high)) break;
      (is_finite_at(line, middle) == low_is_finite ? part.low : part.high) = middle;
    }
    line.*variable_ = part;
    return steps_between_the_ends_of(line);
  }

  const engine::Program& program_;
  Interval LinkBox::*variable_;
  std::size_t slope_;
  double smallest_;
  const std::vector<double>& variables_;
};

constexpr double kSmallestPart = 1e-9;  // of the part of a box that is resolved

/// True if a search along one of the lines finds what it looks for.
/// @param across  the other variable
/// @param within  its places, and the way that is resolved
template <class Finds>
bool finds_along(Interval LinkBox::*variable, Interval LinkBox::*across,
                 const engine::Program& program, const LinkBox& box, const LinkBox& within,
                 const std::vector<double>& variables, const Finds& finds) {
  constexpr int kLines = 9;
  const StepSearch search(program, variable, kSmallestPart * extent_of(within.*variable),
                          variables);
  for (int l = 0; l < kLines; ++l) {
    LinkBox line = box;
    const double place = (within.*across).low + (l + 0.5) / kLines * extent_of(within.*across);
    line.*across = {place, place};
    if (finds(search, line)) return true;
  }
  return false;
}

/// How many variables a program may ask for: the largest number and one more.
std::size_t variables_asked_by(const engine::Program& program) {
  std::size_t count = 0;
  for (const Instruction& instruction : program.code) {
    if (instruction.operation == Operation::kVariable)
      count = std::max<std::size_t>(count, instruction.slot + 1);
  }
  return count;
}

constexpr std::size_t kPins = 5;

/// One value for each variable, within what it lies in.
std::vector<double> pinned_variables(std::size_t count, const LinkBox& box, std::size_t turn) {
  constexpr std::array<double, kPins> kValues{0.5, -1.0, 1e3, 2.0, -1e3};
  std::vector<double> values;
  for (std::size_t slot = 0; slot < count; ++slot) {
    const Interval range = box.variables == nullptr ? kAny : box.variables->at(slot);
    values.push_back(std::clamp(kValues[(turn + slot) % kPins], range.low, range.high));
  }
  return values;
}

/// True if a search along the distance or the speed finds what it looks for, at some values of the variables.
template <class Finds>
bool finds_in_box(const engine::Program& program, const LinkBox& box, const LinkBox& within,
                  const Finds& finds) {
  const std::size_t count = variables_asked_by(program);
  for (std::size_t turn = 0; turn < (count > 0 ? kPins : 1); ++turn) {
    const std::vector<double> values = pinned_variables(count, box, turn);
    std::vector<Interval> points;
    for (const double value : values) points.push_back({value, value});
    LinkBox pinned = box;
    pinned.variables = &points;
    if (finds_along(&LinkBox::distance, &LinkBox::speed, program, pinned, within, values, finds) ||
        finds_along(&LinkBox::speed, &LinkBox::distance, program, pinned, within, values, finds)) {
      return true;
    }
  }
  return false;
}

}  // namespace

SteepestSlopes steepest_slopes(const engine::Program& program, const LinkBox& box) {
  CORDIS_ASSERT(box.bisections > 0);
  CORDIS_ASSERT(engine::is_well_formed(program, kAnyVariables) &&
                engine::is_known_to_laws(program));
  const auto rise = [](const Interval& slope) { return std::max(0.0, slope.high); };
  const auto enough = [](double most, double reached) {
    return most <= (1.0 + kNearEnough) * std::max(0.0, reached);
  };
  return {steepest(program, box, 0, rise, enough, box.bisections),
          steepest(program, box, 1, rise, enough, box.bisections)};
}

bool has_step(const engine::Program& program, const LinkBox& box, const LinkBox& within) {
  CORDIS_ASSERT(engine::is_well_formed(program, kAnyVariables) &&
                engine::is_known_to_laws(program));
  Evaluation whole(box);
  whole.enclose(program);
  if (!whole.is_undecided()) return false;
  return finds_in_box(program, box, within, [](const StepSearch& search, const LinkBox& line) {
    return search.finds_in(line);
  });
}

bool ends_in_a_step(const engine::Program& program, const LinkBox& box) {
  CORDIS_ASSERT(engine::is_well_formed(program, kAnyVariables) &&
                engine::is_known_to_laws(program));
  constexpr int kPlaces = 200;
  Evaluation whole(box);
  whole.enclose(program);
  if (!whole.fails()) return false;
  return finds_in_box(program, box, box, [](const StepSearch& search, const LinkBox& line) {
    return search.finds_end_in(line, kPlaces);
  });
}

bool is_undecided_or_fails(const engine::Program& program, const LinkBox& box) {
  Evaluation evaluation(box);
  evaluation.enclose(program);
  return evaluation.is_undecided() || evaluation.fails();
}

bool has_step_on_line(const engine::Program& program, const LinkBox& line,
                      Interval LinkBox::*variable) {
  constexpr int kPlaces = 1;
  std::vector<double> values;
  if (line.variables != nullptr) {
    for (const Interval& value : *line.variables) values.push_back(value.low);
  }
  const StepSearch search(program, variable, kSmallestPart * extent_of(line.*variable), values);
  return search.finds_end_in(line, kPlaces) || search.finds_in(line);
}

double flattest_slope(const engine::Program& program, const LinkBox& box, double largest) {
  const auto fall = [](const Interval& slope) { return -slope.low; };
  const auto enough = [largest](double most, double reached) {
    return most <= reached + kNearEnough * largest;
  };
  return -steepest(program, box, 0, fall, enough, (box.bisections + 9) / 10);
}

ProgramEnclosure enclosure_of(const engine::Program& program, const LinkBox& box) {
  const Enclosed enclosed = Evaluation(box).enclose(program);
  return {enclosed.value, enclosed.slope[0], enclosed.slope[1]};
}

Interval values_of(const engine::Program& program, const LinkBox& box) {
  return Evaluation(box).enclose(program).value;
}

}  // namespace cordis::plan
