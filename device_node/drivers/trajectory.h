// device_node/drivers/trajectory.h -- a value that moves from target to target in time.
#pragma once

#include <vector>

namespace cordis::device {

/// A piecewise path in one dimension: rests at a value, moves to the next one in a given time,
/// rests again; once, or over and over.
///
/// A move runs straight (kLinear) or with the least jerk, as hands do:
///   x(s) = from + (to - from) (10 s^3 - 15 s^4 + 6 s^5),  s = share of the move's time
/// Source of the latter: Flash and Hogan 1985. A pure function of time, hence exactly repeatable;
/// at the ends of a move it gives the end's value to the last bit.
class Trajectory {
 public:
  enum class Shape { kLinear, kMinimumJerk };

  /// Instants nearer than this are one instant [s]: a time like 0.1 s has no exact binary form. A
  /// jump must not come a sample late for that, nor a move that ends when the next begins be
  /// refused.
  static constexpr double kTimeResolution = 1e-9;

  struct Move {
    double begin_s = 0.0;
    double duration_s = 0.0;  ///< 0: a jump
    double to = 0.0;
  };

  Trajectory() = default;  ///< rests at 0

  /// @param start     value before the first move; a repetition begins where the last move ended
  /// @param moves     in the order of time, without overlap, the first at 0 s or later
  /// @param period_s  length of a repetition, at least the end of the last move; 0: no repetition
  /// @throws std::invalid_argument when moves overlap, run backward, or do not fit the period
  Trajectory(double start, std::vector<Move> moves, Shape shape, double period_s);

  double value_at(double time_s) const noexcept;  ///< value at 0 s for an earlier time
  double rate_at(double time_s) const noexcept;   ///< its derivative [1/s]

 private:
  struct Place {              // where in the path an instant falls
    double from = 0.0;        // value before the move
    double to = 0.0;          // value after it
    double duration_s = 0.0;  // 0 while at rest
    double share = 1.0;       // of the move done, 0..1
  };
  Place locate(double time_s) const noexcept;

  double start_ = 0.0;
  std::vector<Move> moves_;
  Shape shape_ = Shape::kLinear;
  double period_s_ = 0.0;
};

}  // namespace cordis::device
