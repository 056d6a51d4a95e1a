// sim_node/plan/stability/force_field.h -- the slopes of the formulas of a driven force.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/program_enclosure.h"

namespace cordis::plan {

/// Axes of a place, and of a velocity.
inline constexpr std::size_t kAxes = 3;
/// Places along the axes [m], then velocities along them [m/s].
using MotionBox = std::array<Interval, 2 * kAxes>;

/// What a search knows of a slope.
struct FoundSlope {
  Interval within;   ///< no place has one beyond
  Interval reached;  ///< some places have these, as far as what the force asks for is known
};

/// The size of the largest number of an interval.
double largest_of(const Interval& interval) noexcept;

/// The formulas of a force, and what they may meet; of one thread at a time. A coordinate is a place on an axis, or 3
/// more for the velocity along it.
class ForceField {
 public:
  /// @param ranges  of the variables of the network of the function
  ForceField(const engine::TimeFunction& function, const std::vector<Interval>& ranges);

  bool depends_on_place() const { return depends(0); }
  bool depends_on_velocity() const { return depends(kAxes); }
  /// The variables that it asks for, in the order in which they are first asked for.
  const std::vector<std::uint32_t>& asked() const noexcept { return asked_; }
  /// What one of them lies within.
  const Interval& range(std::size_t input) const { return inputs_[input]; }
  bool asks_for_time() const;

  /// The slopes of a component over a coordinate at places and velocities up to an extent. O(instructions), some
  /// thousand enclosures.
  FoundSlope slopes(std::size_t axis, std::size_t coordinate, double extent) const;
  /// What they lie within in a box.
  Interval slope_in(std::size_t axis, std::size_t coordinate, const MotionBox& box) const;
  /// True if a component has a step over a coordinate, at places and velocities up to an extent: where one of its conditions
  /// changes, or where it is no finite number and counts as 0. Looked for on lines through 400 boxes where that may be.
  bool has_step(double extent) const;
  /// What a component lies within in a box.
  Interval value_in(std::size_t axis, const MotionBox& box) const;
  /// The force at a place at rest, at a time and with what it asks for in the middle of its range [N].
  engine::Vec3 at(const engine::Vec3& place) const;

  /// Likewise with time and the variables without an end at 1.
  ForceField with_held_inputs() const;
  /// True if a slope has no bound near the origin because of one variable, though all others and time are at most 1.
  bool has_no_bound_by(std::size_t input) const;
  /// Likewise because of time.
  bool has_no_bound_by_time() const;

  /// Two fields with equal content have the same slopes, whatever the numbers of their variables.
  std::vector<std::uint64_t> content() const;

 private:
  bool depends(std::size_t first) const;
  ForceField with_small_inputs() const;
  bool has_bounds_near_origin() const;
  engine::Program program_over(std::size_t axis, std::size_t coordinate) const;
  /// Valid until the next call.
  LinkBox link_box(std::size_t coordinate, const MotionBox& box) const;
  ProgramEnclosure enclose(const engine::Program& program, std::size_t coordinate,
                           const MotionBox& box) const;
  bool has_step_along(std::size_t axis, std::size_t coordinate, const MotionBox& whole) const;
  std::size_t longest_axis(std::size_t axis, const MotionBox& box) const;
  bool has_step_on_line_through(const engine::Program& program, std::size_t coordinate,
                                const MotionBox& box, std::size_t turn) const;
  struct Extreme {
    double bound;    // no place has more
    double reached;  // some place has this
  };
  Extreme most(std::size_t axis, std::size_t coordinate, const MotionBox& whole, double sign) const;

  engine::TimeFunction function_;     // its variables are numbered as asked_
  std::vector<std::uint32_t> asked_;  // variables of the network
  std::vector<Interval> inputs_;      // of those
  Interval time_{0.0, std::numeric_limits<double>::infinity()};  // [s]
  std::array<std::array<bool, 2 * kAxes>, kAxes> depends_{};
  std::array<std::array<engine::Program, 2 * kAxes>, kAxes> over_;
  mutable std::vector<Interval> variables_;  // of one enclosure
};

}  // namespace cordis::plan
