// device_node/device_config.cpp
#include "device_node/device_config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device_node/drivers/driver_table.h"
#include "node/config/count_text.h"
#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"
#include "node/config/regular_file.h"

namespace cordis::device {
namespace {

using config::count_text;
using config::number_text;
using config::Range;

AxisLayout layout_of(const config::DeviceLimits& limits) {
  AxisLayout layout;
  layout.count = limits.axis_count;
  layout.lowest_m = limits.lowest_m;
  layout.highest_m = limits.highest_m;
  layout.rate_hz = limits.rate_hz;
  layout.force_limit_n = limits.force_limit_n;
  return layout;
}

/// The axes themselves when there is none, or when it is wrong.
EndEffectorMap read_end_effector_map(config::MappingReader& reader, int axis_count,
                                     config::Problems& problems) {
  if (!reader.has("end_piece")) return EndEffectorMap(axis_count);
  config::MappingReader section(reader.optional_mapping("end_piece"), "end_piece", problems);
  const config::Value rows = section.required_sequence("map");
  section.finish();
  std::vector<std::vector<double>> map;
  for (const config::Value& row : rows.items()) {
    std::vector<double>& numbers = map.emplace_back();
    for (const config::Value& entry : row.items()) {
      numbers.push_back(config::read_number(entry, "an entry of the map", 0.0, {}, problems));
    }
  }
  if (!section.ok() || problems.has_errors()) return EndEffectorMap(axis_count);
  try {
    return {map, axis_count};
  } catch (const std::invalid_argument& error) {
    section.error_at("map", error.what());
    return EndEffectorMap(axis_count);
  }
}

constexpr double kLongestWatchdog = 0.2;  // [s]
constexpr double kUsualWatchdog = 6.0;    // periods, where these last longer than 20 ms

/// The watchdog must leave room for the life of an ordinary answer, up to three periods, and for
/// bringing the largest force to zero at the slew rate. It must not be so long, by milliseconds
/// taken for seconds for instance, that a motor pulls on when the scene has died.
void check_watchdog(config::MappingReader& reader, const ForceGuardSettings& guard) {
  const double ordinary_age_s = 3.0 * guard.period_s;
  if (guard.watchdog_s <= ordinary_age_s) {
    reader.error_at("watchdog_s", "watchdog_s must be more than three periods of rate_hz, " +
                                      number_text(ordinary_age_s) + ", got " +
                                      number_text(guard.watchdog_s));
    return;
  }
  const double longest_s = std::max(kLongestWatchdog, kUsualWatchdog * guard.period_s);
  if (guard.watchdog_s > longest_s) {
    reader.error_at("watchdog_s", "watchdog_s must be at most " + number_text(longest_s) +
                                      ", got " + number_text(guard.watchdog_s));
    return;
  }
  const double lowest_slew = guard.limit_n / (guard.watchdog_s - ordinary_age_s);
  if (guard.slew_n_per_s < lowest_slew) {
    reader.error_at("slew_limit_n_per_s",
                    "slew_limit_n_per_s must be at least " + number_text(std::ceil(lowest_slew)) +
                        " so that force_limit_n falls to zero within watchdog_s, got " +
                        number_text(guard.slew_n_per_s));
  }
}

/// What the device is known to be made of, and what follows from it for the passivity observer.
void read_passivity(config::MappingReader& reader, const config::DeviceLimits& limits,
                    ForceGuardSettings& force, config::Problems& problems) {
  PassivitySettings& passivity = force.passivity;
  passivity.period_s = force.period_s;
  passivity.travel_m = limits.highest_m - limits.lowest_m;
  passivity.mass_kg = limits.moving_mass_kg;
  passivity.viscosity_n_s_per_m = limits.viscosity_n_s_per_m;
  const bool known = passivity.viscosity_n_s_per_m > 0.0;
  config::MappingReader section(reader.optional_mapping("passivity"), "passivity", problems);
  passivity.active = section.optional_truth("active", known);
  if (passivity.active && !known) {
    section.error_at("active", "the passivity controller needs viscosity_n_s_per_m of the device");
  }
  passivity.budget_j = section.optional_number("budget_j", 0.001, Range::not_negative());
  const double stored_j = limits.axis_count * force.limit_n * passivity.travel_m;
  passivity.tank_j = section.optional_number("tank_j", stored_j, Range::positive());
  section.finish();
}

/// Where to keep what the motors were given, if anywhere.
void read_trace(config::MappingReader& reader, TraceSettings& trace, config::Problems& problems) {
  if (!reader.has("trace")) return;
  config::MappingReader section(reader.optional_mapping("trace"), "trace", problems);
  trace.file = section.required_text("file");
  const std::filesystem::path folder = std::filesystem::path(trace.file).parent_path();
  std::error_code unknown;
  if (!folder.empty() && !std::filesystem::is_directory(folder, unknown)) {
    section.error_at("file", "there is no folder '" + folder.string() + "' for the trace");
  }
  const std::string reason = config::reason_not_to_write(trace.file);
  if (!reason.empty())
    section.error_at("file", "the trace cannot be written to '" + trace.file + "': " + reason);
  trace.last_s = section.optional_number("last_s", 10.0, Range::between(0.001, 3600.0));
  section.finish();
}

void read_guards(config::MappingReader& reader, DeviceConfig& config, config::Problems& problems) {
  AxisLayout& layout = config.layout;
  ForceGuardSettings& force = config.force_guard;
  force.period_s = 1.0 / layout.rate_hz;
  force.limit_n = layout.force_limit_n;
  force.watchdog_s = reader.optional_number(
      "watchdog_s", std::max(0.02, kUsualWatchdog * force.period_s), Range::positive());
  force.ramp_s = reader.optional_number("start_ramp_s", 0.2, Range::between(0.0, 60.0));
  force.slew_n_per_s = reader.optional_number(
      "slew_limit_n_per_s", 5.0 * force.limit_n / force.watchdog_s, Range::positive());
  if (reader.ok()) check_watchdog(reader, force);
  read_passivity(reader, config.limits, force, problems);

  PositionGuardSettings& position = config.position_guard;
  position.lowest_m = layout.lowest_m;
  position.highest_m = layout.highest_m;
  position.speed_m_per_s = reader.optional_number("speed_limit_m_per_s", 2.0, Range::positive());
  force.power_w = reader.optional_number("power_limit_w", force.limit_n * position.speed_m_per_s,
                                         Range::positive());
  position.ramp_s = force.ramp_s;
  position.watchdog_s = force.watchdog_s;
  position.period_s = force.period_s;
  layout.slew_n_per_s = force.slew_n_per_s;
  layout.power_w = force.power_w;
  layout.start_ramp_s = force.ramp_s;
  layout.watchdog_s = force.watchdog_s;
}

/// A node that plays another's device is received as soon as that falls silent, which takes wall
/// time, and is refused where it would be received between two samples of a device that is not
/// silent.
void check_standby(const DeviceConfig& config, const config::LaunchNode& node, config::Clock clock,
                   config::Problems& problems) {
  constexpr double kLowestRate = 100.0;  // two samples within the deadline of the topic, 20 ms
  if (config.name == node.name) return;
  if (!node.section.find("standby_for").exists()) {
    problems.error(node.place,
                   "'standby_for' belongs in the launch file, where every node of the session "
                   "reads it, and not in the device file of '" +
                       node.name + "'");
  }
  if (clock == config::Clock::kLockstep) {
    problems.error(node.place,
                   "a lockstep session has no hot standby: '" + node.name + "' cannot play '" +
                       config.name + "'",
                   "clock: realtime, or without 'standby_for'");
  }
  if (config.layout.rate_hz < kLowestRate) {
    problems.error(node.place, "'" + node.name + "' is hot standby for '" + config.name +
                                   "', for which rate_hz must be at least " +
                                   number_text(kLowestRate) + ", got " +
                                   number_text(config.layout.rate_hz));
  }
}

/// Builds every driver that the file has a mapping for, and keeps the one in use.
std::unique_ptr<Driver> read_drivers(config::MappingReader& reader, DeviceConfig& config,
                                     config::Problems& problems) {
  std::vector<std::string> names;
  for (const DriverEntry& entry : driver_table()) names.emplace_back(entry.name);
  config.driver = reader.optional_choice("driver", names.front(), names);

  std::unique_ptr<Driver> chosen;
  for (const DriverEntry& entry : driver_table()) {
    const bool in_use = config.driver == entry.name;
    const bool present = reader.has(entry.name);
    config::Value section = reader.optional_mapping(entry.name);
    if (!in_use && !present) continue;
    if (!present) section = config::Value::mapping({}, reader.place_of("driver"));
    if (entry.beneath != nullptr && reader.has(entry.beneath))
      section = config::overlay(reader.optional_mapping(entry.beneath), section);
    auto driver = entry.make(section, config.layout, problems);
    if (in_use) chosen = std::move(driver);
  }
  return chosen;
}

}  // namespace

msg::DeviceDescription description_of(const DeviceConfig& config) {
  msg::DeviceDescription description;
  const config::DeviceLimits& limits = config.limits;
  description.device_id(config.device_id);
  description.device(config.name);
  description.driver(config.driver);
  description.coordinate_count(static_cast<std::uint32_t>(limits.coordinate_count));
  description.rate_hz(limits.rate_hz);
  if (limits.coordinates_are_alike()) {
    description.lowest_m(limits.coordinate_lowest_m[0]);
    description.highest_m(limits.coordinate_highest_m[0]);
  }
  description.key_pitch_m(limits.key_pitch_m);
  description.force_limit_n(limits.force_limit_n);
  description.moving_mass_kg(limits.coordinate_mass_kg());
  description.viscosity_n_s_per_m(limits.coordinate_viscosity_n_s_per_m());
  description.stiffness_limit_n_per_m(limits.stiffness_limit_n_per_m);
  description.damping_limit_n_s_per_m(limits.damping_limit_n_s_per_m);
  description.delay_periods(static_cast<std::uint32_t>(limits.delay_periods));
  description.travel_m(limits.coordinate_travel_m);
  description.force_n(limits.coordinate_force_n);
  return description;
}

std::string what_it_is(const DeviceConfig& config) {
  const int count = config.layout.count;
  const double width_mm = config.limits.key_pitch_m * 1e3;
  if (width_mm == 0.0) {
    return count_text(static_cast<std::size_t>(count), "axis", "axes") + ", driver " +
           config.driver;
  }
  if (count == 1) return fmt::format("1 key, {:.4g} mm wide, driver {}", width_mm, config.driver);
  return fmt::format("{} keys of {:.4g} mm, {:.4g} mm side by side, driver {}", count, width_mm,
                     count * width_mm, config.driver);
}

LoadedDevice read_device(const config::Value& mapping, const std::string& node,
                         config::Problems& problems) {
  LoadedDevice device;
  config::MappingReader reader(mapping, "device '" + node + "'", problems);
  const config::PlayedDevice played = config::read_played_device(reader, node);
  device.config.name = played.name;
  device.config.device_id = config::name_hash(played.name);
  device.config.strength = played.strength;
  reader.optional_integer("cordis", 1, 1, 1);
  device.config.limits = config::read_device_limits(reader);
  device.config.layout = layout_of(device.config.limits);
  device.config.layout.has_other_player = played.name != node;
  device.config.end_effector_map =
      read_end_effector_map(reader, device.config.layout.count, problems);
  read_guards(reader, device.config, problems);
  read_trace(reader, device.config.trace, problems);
  device.driver = read_drivers(reader, device.config, problems);
  reader.finish();
  problems.throw_if_any();
  return device;
}

namespace {

/// Keys and words of the section of a node without a device file that no device file has.
void report_slips(const config::LaunchNode& node, config::Problems& problems) {
  std::vector<config::Value::Entry> keys;
  for (const config::Value::Entry& entry : node.section.entries()) {
    if (entry.key != "device") keys.push_back(entry);
  }
  config::Problems of_the_section;
  try {
    read_device(config::Value::mapping(std::move(keys), node.section.place()), node.name,
                of_the_section);
  } catch (const config::ConfigError& error) {
    for (const config::Problem& problem : error.problems()) {
      const bool is_slip = problem.message.starts_with("unknown key ") ||
                           problem.message.find(" must be one of ") != std::string::npos;
      if (is_slip) problems.error(problem.place, problem.message, problem.hint);
    }
  }
}

}  // namespace

LoadedDevice load_device(const config::Launch& launch, const config::LaunchNode& node,
                         config::Problems& problems) {
  const config::Value mapping = config::device_mapping(launch, node, problems);
  if (!mapping.exists()) report_slips(node, problems);
  if (!mapping.exists()) problems.throw_if_any();
  if (launch.clock == config::Clock::kAsap) {
    problems.error(
        node.place,
        "'" + node.name +
            "' has no place in a session with clock: asap, whose time is not that of a hand",
        "clock: lockstep for simulated hands, clock: realtime for real ones");
  }
  LoadedDevice device = read_device(mapping, node.name, problems);
  check_standby(device.config, node, launch.clock, problems);
  problems.throw_if_any();
  return device;
}

}  // namespace cordis::device
