// sim_node/engine/laws/expression.cpp
#include "sim_node/engine/laws/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sim_node/engine/core/require.h"
#include "sim_node/engine/laws/nearest_zero.h"
#include "sim_node/engine/laws/quadrature.h"
#include "sim_node/engine/laws/scalar_tension.h"

namespace cordis::engine {
namespace {

/// A value that changes with the distance by a constant slope.
struct Line {
  double value = 0.0;  // at the distance of the link
  double slope = 0.0;
  bool is_flat = true;  // does not ask for the distance
};

/// An operation on lines; nothing where no line comes of it.
std::optional<Line> line_of(const Instruction& instruction, const Line* operands) noexcept {
  const Line& u = operands[0];
  const std::size_t count = operand_count(instruction.operation);
  if (std::all_of(operands, operands + count, [](const Line& each) { return each.is_flat; })) {
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < count; ++i) values[i] = operands[i].value;
    return Line{apply(instruction, values.data())};
  }
  if (instruction.operation == Operation::kNegate) return Line{-u.value, -u.slope, false};
  if (count != 2) return std::nullopt;
  const Line& v = operands[1];
  switch (instruction.operation) {
    case Operation::kAdd:
      return Line{u.value + v.value, u.slope + v.slope, false};
    case Operation::kSubtract:
      return Line{u.value - v.value, u.slope - v.slope, false};
    case Operation::kMultiply:
      if (!u.is_flat && !v.is_flat) return std::nullopt;
      return Line{u.value * v.value, u.slope * v.value + u.value * v.slope, false};
    case Operation::kDivide:
      if (!v.is_flat) return std::nullopt;
      return Line{u.value / v.value, u.slope / v.value, false};
    default:
      return std::nullopt;
  }
}

/// The tension at rest as a line over the distance, at the present values of the variables; nothing where it is none.
std::optional<Line> line_of(const Program& program, const LawPoint& link) noexcept {
  std::array<Line, kMaxStack> stack;
  std::size_t depth = 0;
  for (const Instruction& instruction : program.code) {
    const std::size_t taken = operand_count(instruction.operation);
    const std::size_t place = depth - taken;
    if (instruction.operation == Operation::kConstant) {
      stack[place] = {instruction.constant};
    } else if (instruction.operation == Operation::kVariable) {
      stack[place] = {link.variables[instruction.slot]};
    } else if (instruction.operation == Operation::kQuantity) {
      switch (instruction.quantity) {
        case Quantity::kDistance:
          stack[place] = {link.distance, 1.0, false};
          break;
        case Quantity::kElongation:
          stack[place] = {link.elongation, 1.0, false};
          break;
        case Quantity::kMassA:
          stack[place] = {link.mass_a};
          break;
        case Quantity::kMassB:
          stack[place] = {link.mass_b};
          break;
        default:
          stack[place] = {};  // no speed at rest
          break;
      }
    } else {
      const std::optional<Line> line = line_of(instruction, &stack[place]);
      if (!line) return std::nullopt;
      stack[place] = *line;
    }
    depth = place + 1;
  }
  const Line& whole = stack[0];
  if (!std::isfinite(whole.value) || !std::isfinite(whole.slope)) return std::nullopt;
  return whole;
}

/// The potential of a line [J].
double potential_of(const Line& line, const LawPoint& link, bool asks_for_elongation) noexcept {
  if (asks_for_elongation)
    return line.value * link.elongation - 0.5 * line.slope * link.elongation * link.elongation;
  if (line.slope != 0.0) return 0.5 * line.value * line.value / line.slope;
  return line.value * link.distance;
}

}  // namespace

bool is_known_to_laws(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::kDistance:
    case Quantity::kElongation:
    case Quantity::kSpeed:
    case Quantity::kMassA:
    case Quantity::kMassB:
      return true;
    default:
      return false;
  }
}

bool is_known_to_laws(const Program& program) noexcept {
  return std::ranges::all_of(program.code, [](const Instruction& instruction) {
    return instruction.operation != Operation::kQuantity || is_known_to_laws(instruction.quantity);
  });
}

void Expression::check(const std::string& name, std::size_t variable_count) const {
  const std::string what = name + ": expression";
  check_program(program, what, variable_count);
  require(!has_edge(program), what, "one without rising and falling");
  require(is_known_to_laws(program), what + ": quantity",
          "distance, elongation, speed, or the mass of an end");
}

double Expression::distance_of_no_potential(const LawPoint& link) const noexcept {
  const double rest_length = link.distance - link.elongation;
  if (asks_for(program, Quantity::kElongation)) return rest_length;
  if (link.variables == nullptr && asks_for_variable(program)) return 0.0;
  LinkQuantities quantities{};
  quantities[static_cast<std::size_t>(Quantity::kMassA)] = link.mass_a;
  quantities[static_cast<std::size_t>(Quantity::kMassB)] = link.mass_b;
  const auto tension = [&](double distance) {
    quantities[static_cast<std::size_t>(Quantity::kDistance)] = distance;
    return value_of(program, quantities, nullptr, 0.0, link.variables);
  };
  // Rounded, so that all distances of a link, whose rest lengths differ by rounding, have one zero.
  const auto place = static_cast<double>(static_cast<float>(rest_length));
  if (const auto nearest = nearest_zero(tension, place)) return *nearest;
  if (std::isfinite(tension(0.0))) return 0.0;
  return link.distance < 0.0 ? -1.0 : 1.0;
}

double Expression::potential(const LawPoint& link) const noexcept {
  if (asks_for_variable(program)) {
    if (link.variables == nullptr) return 0.0;
    const std::optional<Line> line = line_of(program, link);
    if (line) return potential_of(*line, link, asks_for(program, Quantity::kElongation));
  }
  const double rest_length = link.distance - link.elongation;
  const auto tension = [&](double argument) {
    const LawPoint point{argument,    argument - rest_length, 0.0, link.mass_a,
                         link.mass_b, link.variables};
    return scalar_tension(*this, point, argument);
  };
  return integral_over_distance(tension, distance_of_no_potential(link), link.distance);
}

std::size_t Expression::factor_size(Quantity of) const noexcept {
  constexpr std::size_t kOfProduct = 2;  // the quantity and the multiplication
  if (program.code.size() <= kOfProduct) return 0;
  const std::size_t size = program.code.size() - kOfProduct;
  const Instruction& quantity = program.code[size];
  const bool is_of_it = quantity.operation == Operation::kQuantity && quantity.quantity == of &&
                        program.code.back().operation == Operation::kMultiply;
  if (!is_of_it) return 0;
  bool asks = false;
  for (std::size_t i = 0; i < size; ++i) {
    if (program.code[i].operation == Operation::kQuantity) return 0;
    asks = asks || program.code[i].operation == Operation::kVariable;
  }
  return asks ? size : 0;
}

double Expression::factor(std::size_t size, const double* variables) const noexcept {
  const double value = value_of({program.code.data(), size, variables});
  return std::isfinite(value) ? value : 0.0;
}

/// The largest rise between two samples.
LawSlope Expression::largest_slope(const LawRange& range) const noexcept {
  const auto tension = [&](double argument) {
    LawPoint point{range.rest_length, 0.0, argument, range.mass, range.mass};
    if (!range.viscous)
      point = {argument + range.rest_length, argument, 0.0, range.mass, range.mass};
    return scalar_tension(*this, point, argument);
  };
  LawSlope slope{0.0, false};
  const double step = 2.0 * range.argument / range.samples;
  for (int i = 0; i < range.samples && step > 0.0; ++i) {
    const double argument = -range.argument + step * i;
    const double rise = (tension(argument + step) - tension(argument)) / step;
    if (std::isfinite(rise)) slope.value = std::max(slope.value, rise);
  }
  return slope;
}

}  // namespace cordis::engine
