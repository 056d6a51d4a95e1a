// sim_node/scene/sections/fields.cpp
#include "sim_node/scene/sections/fields.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/assert.h"
#include "sim_node/scene/language/point.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Value;
using engine::MatKind;

/// A vector that must have a value at 0 s. Nothing after a problem.
std::optional<AxisFormulas> read_field(MappingReader& reader, const char* key, int space,
                                       const ParameterValues& parameters,
                                       config::Problems& problems) {
  const std::size_t errors_before = problems.error_count();
  const Value value = reader.optional_value(key);
  AxisFormulas formulas =
      read_axis_formulas(value, reader.name_of(key), space, kNamesOfTime, parameters, "", problems);
  if (problems.error_count() != errors_before) return std::nullopt;
  const engine::Vec3 start = value_at(engine::TimeFunction{formulas, {}, {}, false}, 0.0);
  if (!start.allFinite() || start.cwiseAbs().maxCoeff() > kFarthest) {
    reader.error_at(key, reader.name_of(key) + " is no finite number within 1e6 at 0 s");
    return std::nullopt;
  }
  return formulas;
}

/// The function of a field among those of a network; nothing where there is no field.
std::optional<std::uint32_t> add_function(const std::optional<AxisFormulas>& field,
                                          engine::NetworkDescription& network) {
  if (!field) return std::nullopt;
  network.time_functions.push_back({*field, {}, {}, false});
  return static_cast<std::uint32_t>(network.time_functions.size() - 1);
}

/// Pushes a mass with a factor times a function.
engine::Drive push_with(std::uint32_t mat, std::uint32_t function, double factor) {
  engine::Drive push{mat, function, true};
  for (double& entry : push.turn) entry *= factor;
  return push;
}

}  // namespace

WorldFields read_world(const Value& section, Scene& scene, config::Problems& problems) {
  MappingReader reader(section, "world", problems);
  WorldFields fields;
  const int space = scene.space();
  const Value gravity = reader.optional_value("gravity_m_per_s2");
  scene.gravity_changes = gravity.exists() && has_formula(gravity);
  if (!scene.gravity_changes) {
    scene.network.gravity = optional_point(reader, "gravity_m_per_s2", engine::Vec3::Zero(), space);
  }
  scene.network.medium_viscosity =
      reader.optional_number("viscosity_n_s_per_m", 0.0, config::Range::not_negative());
  scene.medium_flows = reader.optional_value("flow_m_per_s").exists();
  if (scene.gravity_changes || scene.medium_flows) {
    const ParameterValues parameters =
        read_formula_parameters(reader, kNamesOfTime, "formulas of time", problems);
    if (scene.gravity_changes) {
      fields.gravity = read_field(reader, "gravity_m_per_s2", space, parameters, problems);
    }
    if (scene.medium_flows)
      fields.flow = read_field(reader, "flow_m_per_s", space, parameters, problems);
  }
  fields.flow_place = reader.place_of("flow_m_per_s");
  reader.finish();
  return fields;
}

void add_fields(const WorldFields& fields, Scene& scene, config::Problems& problems) {
  if (!fields.gravity && !fields.flow) return;
  engine::NetworkDescription& network = scene.network;
  const std::optional<std::uint32_t> gravity = add_function(fields.gravity, network);
  const std::optional<std::uint32_t> flow = add_function(fields.flow, network);
  std::vector<engine::Drive> drives;
  auto written = network.drives.begin();
  if (flow && !network.has_medium() && !problems.has_errors()) {
    problems.error(fields.flow_place,
                   "a medium that flows needs a viscosity_n_s_per_m > 0 in world, or a "
                   "medium_viscosity_n_s_per_m > 0 of matter");
  }
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const engine::Mat& mat = network.mats[i];
    while (written != network.drives.end() && written->mat == i) drives.push_back(*written++);
    if (mat.kind != MatKind::kMass || !(mat.mass > 0.0)) continue;
    const double viscosity = network.medium_viscosity_on(mat);
    if (gravity && !mat.weightless) drives.push_back(push_with(i, *gravity, mat.mass));
    if (flow && viscosity > 0.0) drives.push_back(push_with(i, *flow, viscosity));
  }
  // The drives stand in the order of their MATs, and each MAT exists.
  CORDIS_ASSERT(written == network.drives.end());
  network.drives = std::move(drives);
}

}  // namespace cordis::scene
