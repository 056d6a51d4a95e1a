// device_node/drivers/script.cpp
#include "device_node/drivers/script.h"

#include <string>
#include <utility>

#include "node/config/mapping_reader.h"

namespace cordis::device {

Script::Script(std::vector<Trajectory> positions, std::vector<Trajectory> forces, double rate_hz)
    : OpenLoopDriver(rate_hz), positions_(std::move(positions)), forces_(std::move(forces)) {}

bool Script::can_play(Role role) const noexcept {
  return !(role == Role::kMass ? positions_ : forces_).empty();
}

bool Script::read(AxisValues& sensed) noexcept {
  sensed.fill(0.0);
  const std::vector<Trajectory>& paths = role() == Role::kMass ? positions_ : forces_;
  const double time_s = period_count() / rate_hz();
  for (std::size_t a = 0; a < paths.size(); ++a) sensed[a] = paths[a].value_at(time_s);
  return true;
}

namespace {

/// How the points of a script are joined.
struct Joining {
  Trajectory::Shape shape = Trajectory::Shape::kMinimumJerk;
  double repeat_s = 0.0;
};

/// Reads one of the two lists of a script: points {at_s: time, <unit>: value, or one per axis}.
std::vector<Trajectory> read_paths(const config::Value& points, const std::string& unit,
                                   const Joining& joining, config::Range range,
                                   const AxisLayout& layout, config::Problems& problems) {
  const auto axis_count = static_cast<std::size_t>(layout.count);
  std::vector<std::vector<Trajectory::Move>> moves(axis_count);
  std::vector<double> start(axis_count, 0.0);
  double last_s = -1.0;
  for (const config::Value& point : points.items()) {
    config::MappingReader reader(point, "point", problems);
    const double at_s = reader.required_number("at_s", config::Range::not_negative());
    std::vector<double> values = reader.required_numbers(unit);
    reader.finish();
    if (reader.ok() && at_s <= last_s)
      reader.error_at("at_s", "at_s must be later than in the point before");
    if (reader.ok() && values.size() != 1 && values.size() != axis_count) {
      reader.error_at(unit, unit + " must be one number, or " + std::to_string(axis_count) +
                                ", one per axis; got " + std::to_string(values.size()));
    }
    for (const double value : values) {
      if (reader.ok() && !(value >= range.lowest && value <= range.highest)) {
        reader.error_at(unit, unit + " must be within " + config::number_text(range.lowest) +
                                  " and " + config::number_text(range.highest) + ", got " +
                                  config::number_text(value));
      }
    }
    if (!reader.ok()) continue;

    for (std::size_t a = 0; a < axis_count; ++a) {
      const double value = values.size() == 1 ? values[0] : values[a];
      if (moves[a].empty()) {
        start[a] = value;
        moves[a].push_back({at_s, 0.0, value});  // where a repetition jumps to
      } else {
        moves[a].push_back({last_s, at_s - last_s, value});
      }
    }
    last_s = at_s;
  }
  if (problems.has_errors() || moves[0].empty()) return {};

  if (joining.repeat_s != 0.0 && joining.repeat_s < last_s) {
    problems.error(points.items().back().place(),
                   "this point comes after repeat_s, the end of a repetition");
    return {};
  }
  std::vector<Trajectory> paths;
  for (std::size_t a = 0; a < axis_count; ++a) {
    paths.emplace_back(start[a], std::move(moves[a]), joining.shape, joining.repeat_s);
  }
  return paths;
}

}  // namespace

std::unique_ptr<Driver> make_script(const config::Value& section, const AxisLayout& layout,
                                    config::Problems& problems) {
  config::MappingReader reader(section, "script", problems);
  Joining joining;
  const std::string word =
      reader.optional_choice("interpolation", "minimum_jerk", {"linear", "minimum_jerk"});
  if (word == "linear") joining.shape = Trajectory::Shape::kLinear;
  joining.repeat_s = reader.optional_number("repeat_s", 0.0, config::Range::not_negative());
  const config::Value positions = reader.optional_sequence("positions");
  const config::Value forces = reader.optional_sequence("forces");
  reader.finish();

  auto position_paths =
      read_paths(positions, "m", joining, config::Range::between(layout.lowest_m, layout.highest_m),
                 layout, problems);
  auto force_paths = read_paths(forces, "n", joining,
                                config::Range::between(-layout.force_limit_n, layout.force_limit_n),
                                layout, problems);
  if (reader.ok() && !problems.has_errors() && position_paths.empty() && force_paths.empty()) {
    problems.error(section.place(), "script needs positions or forces, or both");
  }
  if (problems.has_errors()) return nullptr;
  return std::make_unique<Script>(std::move(position_paths), std::move(force_paths),
                                  layout.rate_hz);
}

}  // namespace cordis::device
