// sim_node/plan/stability/drive_extremes.cpp
#include "sim_node/plan/stability/drive_extremes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace cordis::plan {
namespace {

using engine::NetworkDescription;
using engine::TimeFunction;

/// Calls @p visit with moments [s]. No period has them all at one phase.
template <class Visit>
void at_moments(const NetworkDescription& network, Visit visit) {
  constexpr double kOver = 10.0;     // [s]
  constexpr double kLatest = 100.0;  // [s]
  constexpr double kGolden = 0.618033988749894848;
  constexpr std::size_t kCount = 20'000;
  constexpr std::size_t kMin = 500;
  constexpr std::size_t kLateCount = 1000;
  const auto uneven = [](std::size_t n) {
    const double golden = kGolden * static_cast<double>(n);
    return static_cast<double>(n) + (golden - std::floor(golden));
  };
  const double steps = std::ceil(kOver / network.step);
  const std::size_t wanted = std::max(kMin, kCount / network.time_functions.size());
  const auto count = static_cast<std::size_t>(std::min(static_cast<double>(wanted), steps));
  for (std::size_t n = 0; n < count; ++n) visit(kOver * uneven(n) / static_cast<double>(count));
  const double octaves = std::log2(kLatest / kOver);
  for (std::size_t n = 0; n < kLateCount; ++n) {
    visit(kOver * std::exp2(octaves * uneven(n) / static_cast<double>(kLateCount)));
  }
}

double largest_of_finite(double largest, double value) noexcept {
  return std::isfinite(value) ? std::max(largest, value) : largest;
}

/// A place at a moment.
struct Place {
  double time;  // [s]
  engine::Vec3 place;
};

double mean_speed(const Place& a, const Place& b) noexcept {
  return (b.place - a.place).norm() / (b.time - a.time);
}

/// The speed of the fastest step between two moments, by halving towards the longer way: a jump has all of it.
double speed_between(const NetworkDescription& network, const TimeFunction& function, Place low,
                     Place high) {
  while (high.time - low.time > network.step) {
    const double time = 0.5 * (low.time + high.time);
    const Place middle{time, value_at(function, time)};
    if (!middle.place.allFinite() || !(time > low.time && time < high.time)) return 0.0;
    (mean_speed(low, middle) > mean_speed(middle, high) ? high : low) = middle;
  }
  // A whole step about the middle: it has all of a jump, and of a slide its full speed.
  const double middle = 0.5 * (low.time + high.time);
  const engine::Vec3 way = value_at(function, middle + 0.5 * network.step) -
                           value_at(function, middle - 0.5 * network.step);
  return way.norm() / network.step;
}

double largest_speed(const NetworkDescription& network, const TimeFunction& function) {
  if (!function.time.empty()) return engine::speed_bound_of_table(function);
  double largest = 0.0;
  std::optional<Place> before;
  at_moments(network, [&](double time) {
    const Place now{time, value_at(function, time)};
    const engine::Vec3 way = value_at(function, time + network.step) - now.place;
    largest = largest_of_finite(largest, way.norm() / network.step);
    if (!now.place.allFinite()) return;
    // What has gone farther meanwhile than its largest speed goes has jumped, or has been faster.
    if (before && time > before->time && mean_speed(*before, now) > largest)
      largest = largest_of_finite(largest, speed_between(network, function, *before, now));
    before = now;
  });
  return largest;
}

double largest_value(const NetworkDescription& network, const TimeFunction& function) {
  double largest = 0.0;
  for (const engine::Vec3& value : function.value) largest = std::max(largest, value.norm());
  if (!function.time.empty()) return largest;
  at_moments(network, [&](double time) {
    largest = largest_of_finite(largest, value_at(function, time).norm());
  });
  return largest;
}

/// A force that depends on more than time as it is at the start [N].
/// @param variables  value of each variable of the network
double force_at_start(const NetworkDescription& network, const engine::Drive& drive,
                      const std::vector<double>& variables) {
  const engine::Mat& mat = network.mats[drive.mat];
  return largest_of_finite(
      0.0, force_at(network, drive, {0.0, mat.position, mat.velocity, variables.data()}).norm());
}

/// How much larger a force is than its function: the length of a row, which a rotation keeps.
double factor_of(const engine::Drive& drive) noexcept {
  const std::array<double, 9>& m = drive.turn;
  return std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
}

}  // namespace

double largest_drive_speed(const NetworkDescription& network) {
  std::vector<bool> moves(network.time_functions.size());
  for (const engine::Drive& drive : network.drives) {
    if (!drive.is_force) moves[drive.function] = true;
  }
  double largest = 0.0;
  for (std::size_t f = 0; f < moves.size(); ++f) {
    if (moves[f]) largest = std::max(largest, largest_speed(network, network.time_functions[f]));
  }
  return largest;
}

double sum_of_drive_forces(const NetworkDescription& network) {
  std::vector<double> count(network.time_functions.size(), 0.0);
  const std::vector<double> all_0(network.variables.size(), 0.0);
  double sum = 0.0;
  for (const engine::Drive& drive : network.drives) {
    if (!drive.is_force) continue;
    if (is_of_time(network.time_functions[drive.function])) {
      count[drive.function] += factor_of(drive);
    } else {
      sum += force_at_start(network, drive, all_0);
    }
  }
  for (std::size_t f = 0; f < count.size(); ++f) {
    if (count[f] > 0.0) sum += count[f] * largest_value(network, network.time_functions[f]);
  }
  return sum;
}

}  // namespace cordis::plan
