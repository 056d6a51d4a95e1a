// sim_node/plan/stability/program_enclosure.h -- how steep the value of an expression can become.
#pragma once

#include <limits>
#include <vector>

#include "sim_node/engine/expressions/program.h"

namespace cordis::plan {

/// Numbers from `low` to `high`; infinite ends for what has none.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

inline constexpr Interval kAnyNumber{-std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};

/// What a program may meet of a link. The elongation is the distance less the rest length.
struct LinkBox {
  Interval distance;  ///< [m]
  Interval speed;     ///< [m/s]
  double rest_length = 0.0;
  Interval mass_a;  ///< [kg]
  Interval mass_b;
  Interval force = kAnyNumber;       ///< tension [N], for conditions as the next two
  Interval remembered = kAnyNumber;  ///< age [s], impulse [N s] and stretch of friction [m]
  /// What each variable of the network lies within; null: any number.
  const std::vector<Interval>* variables = nullptr;
  /// Nothing is known of the rest length, nor of the elongation, but for moved_rest.
  bool rest_moves = false;
  Interval moved_rest = kAnyNumber;  ///< what the rest length lies within where it moves [m]
  int bisections = 2000;             ///< at most, for the largest slope; > 0
};

/// No tangent of the program in a box is above these: over the distance, and over the speed.
/// Infinite where a part of it may be no finite number, which counts as 0, where it jumps, or where no largest slope is
/// known. A step between two values that meet in a wide box is left to has_step().
struct SteepestSlopes {
  double over_distance = 0.0;
  double over_speed = 0.0;
};

/// By interval arithmetic on value and derivatives, the box bisected where it is steepest, to 2 %
/// where the bisections of the box are enough. Precondition: well-formed, of quantities known to laws.
SteepestSlopes steepest_slopes(const engine::Program& program, const LinkBox& box);

/// True if the program has a step where one of its conditions changes: on lines over the distance at 9 speeds, and over
/// the speed at 9 distances, at 5 values of each variable. The values at both sides of the place are compared. One of
/// about 1e-9 of what the slopes make of `within` is not seen, nor one that ends between two lines.
/// @param box     where
/// @param within  its part that is resolved to 1e-9, and through which the lines go
/// Where variables alone choose between two values, it is none.
/// Precondition: well-formed, of quantities known to laws.
bool has_step(const engine::Program& program, const LinkBox& box, const LinkBox& within);

/// True if a finite value other than 0 ends where the program is no finite number, which counts as 0: found on the same lines,
/// between two of 200 places. The slopes of such a program are infinite anyway. Precondition: as of has_step().
bool ends_in_a_step(const engine::Program& program, const LinkBox& box);

/// True if it is not decided in a box which of two values is taken, or whether a value is a finite number.
bool is_undecided_or_fails(const engine::Program& program, const LinkBox& box);

/// True if the program has a step on a line, as has_step() or ends_in_a_step() find it.
/// @param line  a box of points, its variables as well, but for one variable
/// @param variable  that one: &LinkBox::distance or &LinkBox::speed, resolved to 1e-9
bool has_step_on_line(const engine::Program& program, const LinkBox& line,
                      Interval LinkBox::*variable);

/// No tangent of the program over the distance in a box is below this, found likewise with a tenth
/// of the bisections, to 2 % of this largest slope; -infinity where SteepestSlopes has infinity.
double flattest_slope(const engine::Program& program, const LinkBox& box, double largest);

/// What the value and its slopes lie within over a box; any number where it is not known.
struct ProgramEnclosure {
  Interval value;
  Interval over_distance;
  Interval over_speed;
};

ProgramEnclosure enclosure_of(const engine::Program& program, const LinkBox& box);

/// What the value lies within over the box.
Interval values_of(const engine::Program& program, const LinkBox& box);

}  // namespace cordis::plan
