// sim_node/scene/sections/fields.cpp
#include "sim_node/scene/sections/fields.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "sim_node/scene/matter/point.h"
#include "sim_node/scene/naming.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Value;
using engine::Instruction;
using engine::MatKind;
using engine::Operation;
using engine::Program;

void append_formula(Program& program, const Program& other) {
  program.code.insert(program.code.end(), other.code.begin(), other.code.end());
}

/// a + factor b, over time; an empty program is 0.
Program sum_of_formulas(const Program& a, const Program& b, double factor) {
  Program result = a;
  if (b.empty()) return result;
  append_formula(result, b);
  Instruction scale;
  scale.operation = Operation::kConstant;
  scale.constant = factor;
  Instruction times;
  times.operation = Operation::kMultiply;
  result.code.insert(result.code.end(), {scale, times});
  if (a.empty()) return result;
  Instruction plus;
  plus.operation = Operation::kAdd;
  result.code.push_back(plus);
  return result;
}

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

/// The acceleration of a mass by the fields.
engine::TimeFunction acceleration(const WorldFields& fields, bool falls, double share_of_flow) {
  engine::TimeFunction function;
  for (std::size_t axis = 0; axis < function.formula.size(); ++axis) {
    const Program gravity = falls && fields.gravity ? (*fields.gravity)[axis] : Program{};
    const Program flow = fields.flow ? (*fields.flow)[axis] : Program{};
    function.formula[axis] = sum_of_formulas(gravity, flow, share_of_flow);
  }
  return function;
}

}  // namespace

WorldFields read_world(const Value& section, Scene& scene, config::Problems& problems) {
  MappingReader reader(section, "world", problems);
  WorldFields fields;
  const int space = scene.space();
  const Value gravity = reader.optional_value("gravity_m_per_s2");
  const bool gravity_changes = gravity.exists() && has_formula(gravity);
  if (!gravity_changes) {
    scene.network.gravity = optional_point(reader, "gravity_m_per_s2", engine::Vec3::Zero(), space);
  }
  scene.network.medium_viscosity =
      reader.optional_number("viscosity_n_s_per_m", 0.0, config::Range::not_negative());
  const bool flows = reader.optional_value("flow_m_per_s").exists();
  if (gravity_changes || flows) {
    const ParameterValues parameters =
        read_formula_parameters(reader, kNamesOfTime, "formulas of time", problems);
    if (gravity_changes) {
      fields.gravity = read_field(reader, "gravity_m_per_s2", space, parameters, problems);
    }
    if (flows) fields.flow = read_field(reader, "flow_m_per_s", space, parameters, problems);
  }
  if (flows && scene.network.medium_viscosity == 0.0 && reader.ok()) {
    reader.error_at("flow_m_per_s", "a medium that flows needs a viscosity_n_s_per_m > 0 in world");
  }
  fields.place = reader.place_of(gravity_changes ? "gravity_m_per_s2" : "flow_m_per_s");
  reader.finish();
  return fields;
}

void add_fields(const WorldFields& fields, Scene& scene, config::Problems& problems) {
  if (!fields.gravity && !fields.flow) return;
  engine::NetworkDescription& network = scene.network;
  std::map<std::pair<bool, double>, std::uint32_t> functions;
  std::vector<engine::Drive> drives;
  auto written = network.drives.begin();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const engine::Mat& mat = network.mats[i];
    const bool is_driven = written != network.drives.end() && written->mat == i;
    if (is_driven) drives.push_back(*written++);
    const bool falls = fields.gravity && !mat.weightless;
    if (mat.kind != MatKind::kMass || !(mat.mass > 0.0) || (!falls && !fields.flow)) continue;
    if (is_driven) {
      problems.error(fields.place, call_mat(scene, i).name +
                                       " is pushed by 'force_n', and cannot be pushed by gravity "
                                       "that changes or by a flow as well");
      return;
    }
    const double share = fields.flow ? network.medium_viscosity / mat.mass : 0.0;
    const auto next = static_cast<std::uint32_t>(network.time_functions.size());
    const auto [function, is_new] = functions.emplace(std::pair(falls, share), next);
    if (is_new) network.time_functions.push_back(acceleration(fields, falls, share));
    engine::Drive push{i, function->second, true};
    for (double& entry : push.turn) entry *= mat.mass;
    drives.push_back(push);
  }
  network.drives = std::move(drives);
}

}  // namespace cordis::scene
