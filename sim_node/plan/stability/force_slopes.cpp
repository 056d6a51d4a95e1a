// sim_node/plan/stability/force_slopes.cpp
#include "sim_node/plan/stability/force_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim_node/plan/stability/force_field.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {
namespace {

using engine::TimeFunction;
using engine::VariableKind;
using engine::Vec3;

constexpr double kLargestMotion = 1e9;  // [m], [m/s]
constexpr const char* kSteps = "its force jumps";
constexpr const char* kNoLargest = "no largest slope over all places and velocities is known";

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

/// All slopes of a force over the places or over the velocities.
using Slopes = std::array<std::array<Interval, kAxes>, kAxes>;

struct FoundSlopes {
  Slopes within;   // no place has one beyond
  Slopes reached;  // some places have these
};

FoundSlopes slopes_over(const ForceField& field, std::size_t first,
                        double extent = kLargestMotion) {
  FoundSlopes slopes;
  for (std::size_t i = 0; i < kAxes; ++i) {
    for (std::size_t j = 0; j < kAxes; ++j) {
      const FoundSlope found = field.slopes(i, first + j, extent);
      slopes.within[i][j] = found.within;
      slopes.reached[i][j] = found.reached;
    }
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

/// True if the bounds are near to slopes that some places have, and those do not go on growing far away.
bool have_largest(const ForceField& field, std::size_t first, const FoundSlopes& slopes) {
  constexpr double kNearer = 1e-3;
  constexpr double kSame = 1.05;
  constexpr double kAsGood = 3.0;
  const double reached = size_of_slopes(slopes.reached);
  if (size_of_slopes(slopes.within) > kAsGood * reached) return false;
  return reached <=
         kSame * size_of_slopes(slopes_over(field, first, kNearer * kLargestMotion).reached);
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

/// Finds why a slope has no bound: because of what alone has that effect, or of all.
void find_unbounded(const ForceField& field, ForceSlopes& slopes) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t input = 0; input < field.asked().size(); ++input) {
    if (!std::isfinite(largest_of(field.range(input)))) all.push_back(input);
    if (field.has_no_bound_by(input)) slopes.variables.push_back(input);
  }
  bool by_time = field.has_no_bound_by_time();
  if (!by_time && slopes.variables.empty()) {
    by_time = field.asks_for_time();
    slopes.variables = all;
  }
  const ForceField held = field.with_held_inputs();
  const bool by_these = (by_time || !slopes.variables.empty()) &&
                        is_finite(slopes_over(held, 0).within) &&
                        is_finite(slopes_over(held, kAxes).within);
  if (!by_these) {
    slopes.variables.clear();
    slopes.uncertainty = kNoLargest;
    return;
  }
  const bool by_both = by_time && !slopes.variables.empty();
  slopes.uncertainty =
      std::string("it asks for ") + (by_time ? "time_s" : "") + (by_both ? " and " : "") +
      (slopes.variables.empty() ? "" : "a signal or a quantity") + ", which nothing bounds";
}

/// @param is_moved  of each variable that the field asks for: a motion of a mass may move it
ForceSlopes slopes_of_field(const ForceField& field, const std::vector<bool>& is_moved,
                            int dimension) {
  ForceSlopes found;
  const bool is_drag = field.depends_on_velocity() && is_none_at_rest(field);
  found.brings_energy = !is_drag;
  const FoundSlopes over_place = slopes_over(field, 0);
  const FoundSlopes over_velocity = slopes_over(field, kAxes);
  if (!is_finite(over_place.within) || !is_finite(over_velocity.within)) {
    find_unbounded(field, found);
    if (found.uncertainty == kNoLargest && field.has_step(kLargestMotion))
      found.uncertainty = kSteps;
    return found;
  }
  if (field.has_step(kLargestMotion)) {
    found.uncertainty = kSteps;
    return found;
  }
  if (!have_largest(field, 0, over_place) || !have_largest(field, kAxes, over_velocity)) {
    found.uncertainty = kNoLargest;
    return found;
  }
  found.stiffness = opposing(over_place.within);
  found.viscosity = opposing(over_velocity.within);
  found.variation = variation_of_slopes(over_place.within);
  std::vector<std::uint32_t> moving;
  for (std::uint32_t input = 0; input < is_moved.size(); ++input) {
    if (is_moved[input]) moving.push_back(input);
  }
  if (!only_opposes(over_velocity.within)) {
    found.uncertainty = "it may drive what moves, and nothing bounds the energy of that";
  } else if (!is_drag && !moving.empty()) {
    found.uncertainty = "it asks for what masses move, and nothing bounds what that brings in";
    found.variables = moving;
  } else if (field.depends_on_place() && works_on_closed_ways(field)) {
    found.uncertainty = "it does work on closed ways, and nothing bounds the energy of that";
  } else if (field.depends_on_place() && drives_away(field, dimension)) {
    found.uncertainty = "it drives its MAT away ever harder";
  }
  return found;
}

}  // namespace

bool is_given(const engine::NetworkDescription& network, const TimeFunction& function) {
  if (asks_for_motion(function)) return false;
  return std::ranges::all_of(function.formula, [&](const engine::Program& formula) {
    return std::ranges::all_of(formula.code, [&](const engine::Instruction& each) {
      return each.operation != engine::Operation::kVariable ||
             is_given(network, network.variables[each.slot]);
    });
  });
}

SlopesOfForces::SlopesOfForces(const engine::NetworkDescription& network) : network_(network) {
  for (const engine::Variable& variable : network.variables)
    ranges_.push_back(range_of_variable(network, variable));
}

ForceSlopes SlopesOfForces::of(const TimeFunction& function) {
  if (is_of_time(function)) return {};
  const ForceField field(function, ranges_);
  std::vector<std::uint64_t> content = field.content();
  std::vector<bool> is_moved;
  for (std::size_t input = 0; input < field.asked().size(); ++input) {
    const Interval& range = field.range(input);
    is_moved.push_back(!is_given(network_, network_.variables[field.asked()[input]]) &&
                       range.low != range.high);
    content.push_back(is_moved.back() ? 1 : 0);
  }
  const auto [known, is_new] = known_.try_emplace(std::move(content));
  if (is_new) known->second = slopes_of_field(field, is_moved, network_.dimension);
  ForceSlopes slopes = known->second;
  for (std::uint32_t& variable : slopes.variables) variable = field.asked()[variable];
  return slopes;
}

}  // namespace cordis::plan
