// sim_node/scene/sections/fields.cpp
#include "sim_node/scene/sections/fields.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/assert.h"
#include "node/config/key_log.h"
#include "sim_node/scene/language/point.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Value;
using engine::MatKind;

/// By dimension.
constexpr std::array<const char*, 3> kExamplesOfGravity{{"-9.81", "[0, -9.81]", "[0, 0, -9.81]"}};

/// True if a field has a value at 0 s; a problem where it has none. That of one that asks for variables is known in a run.
bool has_start(MappingReader& reader, const char* key, const AxisFormulas& formulas) {
  const engine::TimeFunction field{formulas, {}, {}, false};
  if (asks_for_variable(field)) return true;
  const engine::Vec3 start = value_at(field, 0.0);
  if (start.allFinite() && start.cwiseAbs().maxCoeff() <= kFarthest) return true;
  reader.error_at(key, reader.name_of(key) + " is no finite number within 1e6 at 0 s");
  return false;
}

/// A vector that must have a value at 0 s. Nothing after a problem.
std::optional<AxisFormulas> read_field(MappingReader& reader, const char* key, int space,
                                       const ParameterValues& parameters, AskedOutside& outside,
                                       config::Problems& problems) {
  const std::size_t errors_before = problems.error_count();
  const Value value = reader.optional_value(key);
  AxisFormulas formulas = read_axis_formulas(value, reader.name_of(key), space, kNamesOfTime,
                                             parameters, "", problems, &outside);
  if (problems.error_count() != errors_before || !has_start(reader, key, formulas))
    return std::nullopt;
  return formulas;
}

/// The function of a field among those of a network; nothing where there is no field.
std::optional<std::uint32_t> add_function(const std::optional<AxisFormulas>& field,
                                          const std::vector<VariableReference>& references,
                                          Assembly& assembly) {
  if (!field) return std::nullopt;
  std::vector<engine::TimeFunction>& functions = assembly.scene.network.time_functions;
  functions.push_back({*field, {}, {}, false});
  const auto index = static_cast<std::uint32_t>(functions.size() - 1);
  if (asks_for_variable(functions.back()))
    assembly.function_references.push_back({index, references, {}});
  return index;
}

/// Reads the viscosity of the medium: a number of the network, or a formula that is left.
void read_viscosity(MappingReader& reader, const ParameterValues& parameters, AskedOutside& outside,
                    WorldFields& fields, Scene& scene, config::Problems& problems) {
  const config::Range range = config::Range::not_negative();
  if (config::KeyLog* const log = config::KeyLog::current())
    log->add({kViscosity, config::KeyKind::kFormula, false, range, {}, 0, {}, reader.place()});
  const Value value = reader.optional_value(kViscosity);
  if (!value.exists()) return;
  const std::string what = reader.name_of(kViscosity);
  if (is_plain_number(value)) {
    scene.network.medium_viscosity = config::read_number(value, what, 0.0, range, problems);
    return;
  }
  const engine::Program program =
      read_named_formula(value, what, kNamesOfTime, parameters, problems, &outside);
  if (program.empty()) return;
  const engine::Instruction& first = program.code.front();
  if (program.code.size() == 1 && first.operation == engine::Operation::kConstant) {
    const Value as_written = Value::scalar(config::number_text(first.constant), value.place());
    scene.network.medium_viscosity = config::read_number(as_written, what, 0.0, range, problems);
    return;
  }
  if (!has_start(reader, kViscosity, {program})) return;
  fields.viscosity = program;
  fields.viscosity_place = value.place();
  scene.medium_changes = true;
}

/// Z (u - v) along each axis.
AxisFormulas drag_of(const WorldFields& fields, int space) {
  AxisFormulas drag;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(space); ++axis) {
    std::vector<engine::Instruction>& code = drag[axis].code;
    const engine::Quantity velocity = engine::kVelocityInForce[axis];
    if (fields.flow) code = (*fields.flow)[axis].code;
    code.push_back({engine::Operation::kQuantity, velocity, 0.0, 0});
    const auto of_velocity =
        fields.flow ? engine::Operation::kSubtract : engine::Operation::kNegate;
    code.push_back({of_velocity, engine::Quantity::kDistance, 0.0, 0});
    code.insert(code.end(), fields.viscosity.code.begin(), fields.viscosity.code.end());
    code.push_back({engine::Operation::kMultiply, engine::Quantity::kDistance, 0.0, 0});
  }
  return drag;
}

/// Pushes a mass with a factor times a function.
engine::Drive push_with(std::uint32_t mat, std::uint32_t function, double factor) {
  engine::Drive push{mat, function, true};
  for (double& entry : push.turn) entry *= factor;
  return push;
}

}  // namespace

WorldFields read_world(const Value& section, const std::set<std::string>& signals, Scene& scene,
                       config::Problems& problems) {
  MappingReader reader(section, "world", problems);
  WorldFields fields;
  const int space = scene.space();
  for (const char* key : {"gravity_m_per_s2", "flow_m_per_s"})
    reader.describe({.key = key, .kind = config::KeyKind::kFormulaVector});
  const Value gravity = reader.optional_value("gravity_m_per_s2");
  scene.gravity_changes = gravity.exists() && has_formula(gravity);
  if (!scene.gravity_changes) {
    scene.network.gravity = optional_point(reader, "gravity_m_per_s2", engine::Vec3::Zero(), space,
                                           kExamplesOfGravity[static_cast<std::size_t>(space) - 1]);
  }
  scene.medium_flows = reader.optional_value("flow_m_per_s").exists();
  const std::size_t errors_before = problems.error_count();
  const ParameterValues parameters =
      read_formula_parameters(reader, kNamesOfTime, "formulas of time", problems);
  AskedOutside outside{signals, fields.references};
  read_viscosity(reader, parameters, outside, fields, scene, problems);
  if (scene.gravity_changes) {
    fields.gravity = read_field(reader, "gravity_m_per_s2", space, parameters, outside, problems);
  }
  if (scene.medium_flows)
    fields.flow = read_field(reader, "flow_m_per_s", space, parameters, outside, problems);
  fields.flow_place = reader.place_of("flow_m_per_s");
  reader.finish();
  if (problems.error_count() == errors_before)
    parameters.warn_of_unused(reader.optional_value("parameters"), reader.what(), problems);
  return fields;
}

void add_fields(const WorldFields& fields, Assembly& assembly) {
  const bool drags = !fields.viscosity.empty();
  if (!fields.gravity && !fields.flow && !drags) return;
  engine::NetworkDescription& network = assembly.scene.network;
  config::Problems& problems = assembly.problems;
  const std::optional<std::uint32_t> gravity =
      add_function(fields.gravity, fields.references, assembly);
  const std::optional<std::uint32_t> flow = add_function(fields.flow, fields.references, assembly);
  std::optional<AxisFormulas> drag_formulas;
  if (drags) drag_formulas = drag_of(fields, assembly.scene.space());
  const std::optional<std::uint32_t> drag =
      add_function(drag_formulas, fields.references, assembly);
  const std::size_t variables = std::numeric_limits<std::size_t>::max();
  if (drag && !engine::is_well_formed((*drag_formulas)[0], variables)) {
    problems.error(fields.viscosity_place, "'viscosity_n_s_per_m' in world is nested too deeply");
  }
  std::vector<engine::Drive> drives;
  auto written = network.drives.begin();
  if (flow && !drags && !network.has_medium() && !problems.has_errors()) {
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
    if (drag && mat.medium_viscosity < 0.0) {
      drives.push_back(push_with(i, *drag, 1.0));
    } else if (flow && viscosity > 0.0) {
      drives.push_back(push_with(i, *flow, viscosity));
    }
  }
  // The drives stand in the order of their MATs, and each MAT exists.
  CORDIS_ASSERT(written == network.drives.end());
  network.drives = std::move(drives);
  assembly.scene.gravity_function = gravity;
  assembly.scene.medium_function = drag;
}

}  // namespace cordis::scene
