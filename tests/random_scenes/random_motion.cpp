// tests/random_scenes/random_motion.cpp
#include "tests/random_scenes/random_motion.h"

#include <functional>

#include <fmt/format.h>

namespace cordis::test {
namespace {

/// `[a, b, c]`, one text for each axis.
std::string for_each_axis(int space, const std::function<std::string(int)>& text_of) {
  std::string text = "[";
  for (int axis = 0; axis < space; ++axis) text += (axis > 0 ? ", " : "") + text_of(axis);
  return text + "]";
}

std::string number(double value) {
  return fmt::format("{:.4g}", value);
}

/// A number, or a formula of the number and the place of a mass, up to this size.
std::string start_of_axis(RandomNumbers& numbers, int space, double size) {
  const char axis = "xyz"[numbers.below(static_cast<std::uint32_t>(space))];
  const double most = numbers.between(-size, size);
  switch (numbers.below(6)) {
    case 0:
      return number(most);
    case 1:
      return fmt::format("\"{:.4g} * sin(pi * index / count)\"", most);
    case 2:
      return fmt::format("\"{:.4g} * (2 * index - count) / count\"", most);
    case 3:
      return fmt::format("\"{:.4g} * sin(20 * {}_m)\"", most, axis);
    case 4:
      return fmt::format("\"share * {:.4g} * {}_m\"", 10.0 * most, axis);
    default:
      return fmt::format("\"if(index < 1, {:.4g}, 0)\"", most);
  }
}

/// A formula of time that is this at 0 s.
std::string formula_of_time(RandomNumbers& numbers, double start, double size) {
  const double swing = numbers.between(-size, size);
  const double rate = numbers.between(2.0, 80.0);
  return fmt::format("\"{:.4g} + {:.4g} * sin({:.4g} * time_s)\"", start, swing, rate);
}

/// A table of time. @param half  of what it begins at @param size  of how far it goes
std::string table_of_time(RandomNumbers& numbers, int space, double half, double size) {
  double start[3] = {};
  for (double& each : start) each = numbers.between(-half, half);
  std::string rows;
  for (int row = 0; row < 4; ++row) {
    rows += row > 0 ? ", " : "";
    rows += for_each_axis(space, [&](int axis) {
      return number(start[axis] + (row == 0 ? 0.0 : numbers.between(-size, size)));
    });
  }
  return fmt::format("{{at_s: [0.001, 0.02, 0.05, 0.09], values: [{}], between: {}}}", rows,
                     numbers.one_of<const char*>({"smooth", "linear"}));
}

std::string function_of_time(RandomNumbers& numbers, int space, double half, double size) {
  if (numbers.chance(0.4)) return table_of_time(numbers, space, half, size);
  return for_each_axis(space, [&](int) {
    const double start = numbers.between(-half, half);
    return formula_of_time(numbers, start, size);
  });
}

/// A force towards the origin as 1 / r^2, softened, and a drag.
std::string force_of_centre(RandomNumbers& numbers, int space) {
  const char* const square[] = {"x_m^2", "x_m^2 + y_m^2", "x_m^2 + y_m^2 + z_m^2"};
  const double strength = numbers.decades(1e-4, 1e-2);
  const double drag = numbers.chance(0.5) ? numbers.decades(1e-4, 1e-2) : 0.0;
  return for_each_axis(space,
                       [&](int axis) {
                         return fmt::format(
                             "\"-gm * {0}_m / ({1} + 0.01)^1.5 - {2:.4g} * velocity_{0}_m_per_s\"",
                             "xyz"[axis], square[space - 1], drag);
                       }) +
         fmt::format(", parameters: {{gm: {:.4g}}}", strength);
}

}  // namespace

std::string random_start(RandomNumbers& numbers, int space) {
  const std::uint32_t which = numbers.below(3);
  std::string text;
  const auto add = [&](const char* key, double size) {
    text += fmt::format(", {}: ", key);
    text += for_each_axis(space, [&](int) { return start_of_axis(numbers, space, size); });
  };
  if (which != 0) add("displacement_m", 0.03);
  if (which != 1) add("velocity_m_per_s", 0.5);
  return text.find("share") == std::string::npos ? text : text + ", parameters: {share: 0.5}";
}

std::string random_drive_of_position(RandomNumbers& numbers, int space, double half) {
  return ", driven: {position_m: " + function_of_time(numbers, space, half, 0.02) + "}";
}

std::string random_drive_of_part(RandomNumbers& numbers, int space, bool may_move) {
  if (may_move && numbers.chance(0.7))
    return ", driven: {displacement_m: " + function_of_time(numbers, space, 0.0, 0.02) + "}";
  if (numbers.chance(0.5))
    return ", driven: {force_n: " + function_of_time(numbers, space, 0.02, 0.05) + "}";
  return ", driven: {force_n: " + force_of_centre(numbers, space) + "}";
}

std::string random_asking_formula(RandomNumbers& numbers, bool of_motion) {
  if (of_motion) {
    return numbers.one_of<const char*>(
        {"tanh(5 * middle)", "min(fastest, 1)", "max(-1, min(1, thrust))", "tanh(100 * lively)"});
  }
  return numbers.one_of<const char*>(
      {"tanh(20 * place_of_wall)", "if(changed > 2, 1, -0.5)", "min(0.1 * changed, 1)"});
}

std::string random_viscosity(RandomNumbers& numbers, double size) {
  const double swing = numbers.between(-0.9, 0.9);
  const double rate = numbers.decades(2.0, 500.0);
  switch (numbers.below(4)) {
    case 0:
      return fmt::format("\"{:.4g} * (1 + {:.4g} * sin({:.4g} * time_s))\"", size, swing, rate);
    case 1:
      return fmt::format("\"{:.4g} * (1 - {:.4g} * exp(-{:.4g} * time_s))\"", size, swing, rate);
    case 2:
      return fmt::format("\"{:.4g} * (1 + {:.4g} * {})\"", size, swing,
                         random_asking_formula(numbers, false));
    default:
      return fmt::format("\"{:.4g} * (1 + {:.4g} * {})\"", size, swing,
                         random_asking_formula(numbers, true));
  }
}

}  // namespace cordis::test
