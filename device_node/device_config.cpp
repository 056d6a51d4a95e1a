// device_node/device_config.cpp
#include "device_node/device_config.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "device_node/drivers/driver_table.h"
#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"

namespace cordis::device {
namespace {

using config::number_text;
using config::Range;

/// The device file with the other keys of the section laid on it.
config::Value merged(const config::Launch& launch, const config::LaunchNode& node,
                     config::Problems& problems) {
  config::MappingReader reader(node.section, "device_node '" + node.name + "'", problems);
  const std::string path = reader.required_text("device");
  if (path.empty()) return {};

  std::vector<config::Value::Entry> others;
  for (const config::Value::Entry& entry : node.section.entries()) {
    if (entry.key != "device") others.push_back(entry);
  }
  const config::Value file = config::load_file(launch.resolve(path).string(), problems);
  if (!file.exists()) return {};
  return config::overlay(file, config::Value::mapping(std::move(others), node.section.place()));
}

AxisLayout read_layout(config::MappingReader& reader) {
  AxisLayout layout;
  layout.count = static_cast<int>(reader.required_integer("axes", 1, kMaxAxes));
  const double travel_m = reader.optional_number("travel_m", 0.04, Range::between(0.001, 1.0));
  const std::string rest = reader.optional_choice("rest", "top", {"top", "middle", "bottom"});
  layout.lowest_m = rest == "top" ? -travel_m : rest == "middle" ? -travel_m / 2.0 : 0.0;
  layout.highest_m = layout.lowest_m + travel_m;
  layout.rate_hz = reader.optional_number("rate_hz", 1000.0, Range::between(1.0, 20000.0));
  layout.force_limit_n = reader.optional_number("force_limit_n", 20.0, Range::positive());
  return layout;
}

/// The watchdog must leave room for the life of an ordinary answer, up to three periods, and for
/// bringing the largest force to zero at the slew rate.
void check_watchdog(config::MappingReader& reader, const ForceGuardSettings& guard) {
  const double ordinary_age_s = 3.0 * guard.period_s;
  if (guard.watchdog_s <= ordinary_age_s) {
    reader.error_at("watchdog_s", "watchdog_s must be more than three periods of rate_hz, " +
                                      number_text(ordinary_age_s) + ", got " +
                                      number_text(guard.watchdog_s));
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

/// What the device is known to be made of, and what follows from it for the energy monitor.
void read_passivity(config::MappingReader& reader, const AxisLayout& layout,
                    ForceGuardSettings& force, config::Problems& problems) {
  PassivitySettings& passivity = force.passivity;
  passivity.period_s = force.period_s;
  passivity.travel_m = layout.highest_m - layout.lowest_m;
  passivity.mass_kg = reader.optional_number("moving_mass_kg", 0.05, Range::between(1e-4, 100.0));
  passivity.viscosity_n_s_per_m =
      reader.optional_number("viscosity_n_s_per_m", 0.0, Range::not_negative());
  const bool known = passivity.viscosity_n_s_per_m > 0.0;
  config::MappingReader section(reader.optional_mapping("passivity"), "passivity", problems);
  passivity.active = section.optional_truth("active", known);
  if (passivity.active && !known) {
    section.error_at("active", "the passivity controller needs viscosity_n_s_per_m of the device");
  }
  passivity.budget_j = section.optional_number("budget_j", 0.001, Range::not_negative());
  const double stored_j = layout.count * force.limit_n * passivity.travel_m;
  passivity.tank_j = section.optional_number("tank_j", stored_j, Range::positive());
  section.finish();
}

/// Where to keep what the motors were given, if anywhere.
void read_trace(config::MappingReader& reader, TraceSettings& trace, config::Problems& problems) {
  if (!reader.has("trace")) return;
  config::MappingReader section(reader.optional_mapping("trace"), "trace", problems);
  trace.file = section.required_text("file");
  trace.last_s = section.optional_number("last_s", 10.0, Range::between(0.001, 3600.0));
  section.finish();
}

void read_guards(config::MappingReader& reader, DeviceConfig& config, config::Problems& problems) {
  const AxisLayout& layout = config.layout;
  ForceGuardSettings& force = config.force_guard;
  force.period_s = 1.0 / layout.rate_hz;
  force.limit_n = layout.force_limit_n;
  force.watchdog_s =
      reader.optional_number("watchdog_s", std::max(0.02, 6.0 * force.period_s), Range::positive());
  force.ramp_s = reader.optional_number("start_ramp_s", 0.2, Range::between(0.0, 60.0));
  force.slew_n_per_s = reader.optional_number(
      "slew_limit_n_per_s", 5.0 * force.limit_n / force.watchdog_s, Range::positive());
  if (reader.ok()) check_watchdog(reader, force);
  read_passivity(reader, layout, force, problems);

  PositionGuardSettings& position = config.position_guard;
  position.lowest_m = layout.lowest_m;
  position.highest_m = layout.highest_m;
  position.speed_m_per_s = reader.optional_number("speed_limit_m_per_s", 2.0, Range::positive());
  force.power_w = reader.optional_number("power_limit_w", force.limit_n * position.speed_m_per_s,
                                         Range::positive());
  position.ramp_s = force.ramp_s;
  position.watchdog_s = force.watchdog_s;
  position.period_s = force.period_s;
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
    if (!present) section = config::Value::mapping({}, reader.place());
    auto driver = entry.make(section, config.layout, problems);
    if (in_use) chosen = std::move(driver);
  }
  return chosen;
}

}  // namespace

LoadedDevice read_device(const config::Value& mapping, const std::string& name,
                         config::Problems& problems) {
  LoadedDevice device;
  config::MappingReader reader(mapping, "device '" + name + "'", problems);
  device.config.name = name;
  device.config.device_id = config::name_hash(name);
  reader.optional_integer("cordis", 1, 1, 1);
  device.config.layout = read_layout(reader);
  read_guards(reader, device.config, problems);
  read_trace(reader, device.config.trace, problems);
  device.driver = read_drivers(reader, device.config, problems);
  reader.finish();
  problems.throw_if_any();
  return device;
}

LoadedDevice load_device(const config::Launch& launch, const config::LaunchNode& node,
                         config::Problems& problems) {
  const config::Value mapping = merged(launch, node, problems);
  problems.throw_if_any();
  return read_device(mapping, node.name, problems);
}

}  // namespace cordis::device
