// node/config/device_limits.cpp
#include "node/config/device_limits.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "node/config/file_kind.h"
#include "node/config/yaml_reader.h"

namespace cordis::config {

Value device_mapping(const Launch& launch, const LaunchNode& node, Problems& problems) {
  MappingReader reader(node.section, "device_node '" + node.name + "'", problems);
  const std::string path = reader.required_text("device");
  if (path.empty()) return {};

  std::vector<Value::Entry> others;
  for (const Value::Entry& entry : node.section.entries()) {
    if (entry.key != "device") others.push_back(entry);
  }
  const Value file = load_file(launch.resolve(path).string(), problems);
  if (!file.exists() || !is_file_of(FileKind::kDevice, file, problems)) return {};
  return overlay(file, Value::mapping(std::move(others), node.section.place()));
}

namespace {

using Map = std::vector<std::vector<double>>;

/// One row per coordinate; none without an end-effector map. Faults in it are reported by the device itself.
Map read_map(MappingReader& reader) {
  Problems reported_elsewhere;
  Map map;
  for (const Value& row : reader.optional_mapping("end_piece").find("map").items()) {
    std::vector<double>& numbers = map.emplace_back();
    for (const Value& entry : row.items()) {
      numbers.push_back(read_number(entry, "an entry", 0.0, {}, reported_elsewhere));
    }
  }
  return map;
}

/// The largest sum of a row of |A A^T|, which no eigenvalue exceeds.
double inertia_ratio_of(const Map& map) {
  double largest = 0.0;
  for (const std::vector<double>& a : map) {
    double sum = 0.0;
    for (const std::vector<double>& b : map) {
      const std::size_t count = std::min(a.size(), b.size());
      sum += std::abs(std::inner_product(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(count),
                                         b.begin(), 0.0));
    }
    largest = std::max(largest, sum);
  }
  return largest > 0.0 ? largest : 1.0;
}

/// By q = A x the axes, each within its travel, carry a coordinate by the sum of |A| of its row;
/// by f = A^T F a force along it alone reaches the limit first at the axis of the largest |A|.
void set_reach(DeviceLimits& limits, const Map& map) {
  const std::vector<double> one{1.0};
  for (std::size_t c = 0; c < limits.coordinate_travel_m.size(); ++c) {
    if (c >= static_cast<std::size_t>(limits.coordinate_count)) break;
    double lowest = 0.0;
    double highest = 0.0;
    double largest = 0.0;
    for (const double entry : map.empty() ? one : map[c]) {
      lowest += entry * (entry > 0.0 ? limits.lowest_m : limits.highest_m);
      highest += entry * (entry > 0.0 ? limits.highest_m : limits.lowest_m);
      largest = std::max(largest, std::abs(entry));
    }
    limits.coordinate_lowest_m[c] = lowest;
    limits.coordinate_highest_m[c] = highest;
    limits.coordinate_travel_m[c] = highest - lowest;
    limits.coordinate_force_n[c] = largest > 0.0 ? limits.force_limit_n / largest : 0.0;
  }
}

}  // namespace

bool DeviceLimits::coordinates_are_alike() const noexcept {
  for (int c = 1; c < coordinate_count; ++c) {
    const auto other = static_cast<std::size_t>(c);
    if (coordinate_lowest_m[other] != coordinate_lowest_m[0]) return false;
    if (coordinate_highest_m[other] != coordinate_highest_m[0]) return false;
  }
  return true;
}

DeviceLimits read_device_limits(MappingReader& reader) {
  constexpr int kMaxDelay = 16;
  DeviceLimits limits;
  limits.axis_count = static_cast<int>(reader.required_integer("axes", 1, kMaxAxes));
  limits.coordinate_count = limits.axis_count;
  const Map map = read_map(reader);
  if (!map.empty()) {
    limits.coordinate_count = static_cast<int>(map.size());
    limits.inertia_ratio = inertia_ratio_of(map);
  }
  const double travel_m = reader.optional_number("travel_m", 0.04, Range::between(0.001, 1.0));
  const std::string rest = reader.optional_choice("rest", "top", {"top", "middle", "bottom"});
  limits.lowest_m = rest == "top" ? -travel_m : rest == "middle" ? -travel_m / 2.0 : 0.0;
  limits.highest_m = limits.lowest_m + travel_m;
  limits.key_pitch_m = reader.optional_number("key_pitch_m", 0.0, Range::between(0.002, 0.2));
  limits.rate_hz = reader.optional_number("rate_hz", 1000.0, Range::between(1.0, 20000.0));
  limits.force_limit_n = reader.optional_number("force_limit_n", 20.0, Range::positive());
  set_reach(limits, map);
  limits.moving_mass_kg =
      reader.optional_number("moving_mass_kg", 0.05, Range::between(1e-4, 100.0));
  limits.viscosity_n_s_per_m =
      reader.optional_number("viscosity_n_s_per_m", 0.0, Range::not_negative());
  limits.stiffness_limit_n_per_m =
      reader.optional_number("stiffness_limit_n_per_m", 0.0, Range::not_negative());
  limits.damping_limit_n_s_per_m =
      reader.optional_number("damping_limit_n_s_per_m", 0.0, Range::not_negative());
  limits.delay_periods =
      static_cast<int>(reader.optional_integer("delay_periods", 0, 0, kMaxDelay));
  return limits;
}

PlayedDevice read_played_device(MappingReader& reader, const std::string& node) {
  constexpr int kOwn = 10;
  constexpr int kStandbyStrength = 5;
  PlayedDevice played;
  played.name = reader.optional_text("standby_for", node);
  played.strength = static_cast<int>(
      reader.optional_integer("strength", played.name == node ? kOwn : kStandbyStrength, 1, 1000));
  return played;
}

}  // namespace cordis::config
