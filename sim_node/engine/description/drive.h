// sim_node/engine/description/drive.h -- MATs that follow a function of time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/expressions/program.h"

namespace cordis::engine {

struct NetworkDescription;

/// The quantities of a link that stand for the place of a MAT along each axis [m] in the formulas of a
/// force on it.
inline constexpr std::array<Quantity, 3> kPlaceInForce{Quantity::kDistance, Quantity::kElongation,
                                                       Quantity::kRestLength};
/// Likewise for its velocity, as dampers see it [m/s].
inline constexpr std::array<Quantity, 3> kVelocityInForce{Quantity::kSpeedX, Quantity::kSpeedY,
                                                          Quantity::kSpeedZ};

/// A vector that depends on time: a formula for each axis, or a table. That of a force may depend on the
/// place and the velocity of its MAT and on variables of the network too.
///
/// A table keeps its first value before its first time, and its last one after the last time.
/// Between two times it goes straight from one value to the next. A smooth one goes along cubics
/// whose slopes are continuous (those of Fritsch and Butland). Along each axis it is never beyond
/// the two values.
struct TimeFunction {
  /// Per axis, of Quantity::kAge: here the time since step 0 [s]. Of a force also of what stands for its MAT and
  /// of variables. Empty: 0.
  std::array<Program, 3> formula;
  std::vector<double> time;  ///< table: times [s], each larger than the one before; empty: none
  std::vector<Vec3> value;   ///< table: values at these times
  bool smooth = false;       ///< table: it goes along cubics
};

/// True if it depends on the place or the velocity of a MAT. O(instructions).
bool asks_for_motion(const TimeFunction& function) noexcept;
/// True if it depends on variables of the network. O(instructions).
bool asks_for_variable(const TimeFunction& function) noexcept;
/// True if it depends on neither. O(instructions).
bool is_of_time(const TimeFunction& function) noexcept;

/// What a function may depend on.
struct FunctionPoint {
  double time = 0.0;                  ///< since step 0 [s]
  Vec3 position = Vec3::Zero();       ///< place of the MAT [m]
  Vec3 velocity = Vec3::Zero();       ///< [m/s]
  const double* variables = nullptr;  ///< values of those of the network; may be null
};

/// The value at a point; its components may be no finite numbers. The same bits everywhere. Real time:
/// O(instructions), of a table O(log(times)); no allocation. Precondition: it asks for no variable without
/// their values.
Vec3 value_at(const TimeFunction& function, const FunctionPoint& point) noexcept;
/// Likewise at a time [s], with all else 0.
Vec3 value_at(const TimeFunction& function, double time) noexcept;

/// One MAT that follows a function of time: its position, or a force from outside on it.
///
///     position = origin + turn F(t)      of a MatKind::kPort, which nothing else moves
///     force    = turn F(t)               on a MatKind::kMass, beside all others
///     force    = turn F(t, y, w)         likewise, y = turn^T (x - origin) and w = turn^T v of the MAT
///
/// The time of step n is n dt, never a sum. The velocity that dampers see is the difference
/// quotient of the last period, (x(n) - x(n-1)) / dt, as that of every other MAT. So the work of
/// the drive is exactly what its liaisons receive. It begins with the quotient of the first period.
struct Drive {
  std::uint32_t mat = 0;
  std::uint32_t function = 0;  ///< index in NetworkDescription::time_functions
  bool is_force = false;
  Vec3 origin = Vec3::Zero();  ///< added to a position [m]
  std::array<double, 9> turn{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};  ///< rows of a matrix
};

/// No slope of a table along time is larger [1/s of its unit]; 0 of a formula. O(times).
double speed_bound_of_table(const TimeFunction& table) noexcept;

/// Position [m] or force [N] of a drive whose function has this value. Real time: O(1).
Vec3 placed(const Drive& drive, const Vec3& value) noexcept;
/// Position [m] or force [N] of a drive at a time [s]. Real time as of the other value_at().
/// Precondition: its function is of time.
Vec3 value_at(const NetworkDescription& network, const Drive& drive, double time) noexcept;
/// Force [N] of a drive on its MAT where that is. Real time as of the other value_at().
Vec3 force_at(const NetworkDescription& network, const Drive& drive,
              const FunctionPoint& point) noexcept;
/// Where a MAT whose position is driven is at the start [m].
Vec3 start_of(const NetworkDescription& network, const Drive& drive) noexcept;

/// True where a position jumps between two times: more than half of its way lies within a thousandth of
/// the period. A way of less than 1e-12 m, or of some roundings, is no jump. `before` and `next` are its values there. Real time: 11 values.
bool jumps(const NetworkDescription& network, const Drive& drive, double from, double to,
           const Vec3& before, const Vec3& next) noexcept;

/// @throws std::invalid_argument beginning with `name`
void check_time_function(const NetworkDescription& network, const TimeFunction& function,
                         const std::string& name);
void check_drive(const NetworkDescription& network, const Drive& drive, const std::string& name);

}  // namespace cordis::engine
