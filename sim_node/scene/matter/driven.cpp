// sim_node/scene/matter/driven.cpp
#include "sim_node/scene/matter/driven.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim_node/scene/language/named_formula.h"
#include "sim_node/scene/language/point.h"
#include "sim_node/scene/language/quantity.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Problems;
using config::Value;
using engine::MatKind;
using engine::TimeFunction;
using engine::Vec3;

constexpr double kSamePlace = 1e-9;  // [m]

struct DriveKey {
  const char* key;
  DriveSpec::Kind kind;
};
constexpr std::array<DriveKey, 3> kDriveKeys{{{"position_m", DriveSpec::Kind::kPosition},
                                              {"displacement_m", DriveSpec::Kind::kDisplacement},
                                              {"force_n", DriveSpec::Kind::kForce}}};

constexpr std::array<const char*, 3> kPlaceWords{"x_m", "y_m", "z_m"};
constexpr std::array<const char*, 3> kVelocityWords{"velocity_x_m_per_s", "velocity_y_m_per_s",
                                                    "velocity_z_m_per_s"};

/// What the formulas of a force may ask for by these names.
std::vector<FormulaName> names_of_force(int space) {
  std::vector<FormulaName> names(kNamesOfTime.begin(), kNamesOfTime.end());
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(space); ++axis)
    names.push_back({kPlaceWords[axis], engine::kPlaceInForce[axis]});
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(space); ++axis)
    names.push_back({kVelocityWords[axis], engine::kVelocityInForce[axis]});
  return names;
}

void read_table(const Value& value, const std::string& what, int space, TimeFunction& function,
                Problems& problems) {
  MappingReader reader(value, what, problems);
  function.time = reader.required_numbers("at_s");
  function.value = required_points(reader, "values", space, problems);
  function.smooth = reader.optional_choice("between", "linear", {"linear", "smooth"}) == "smooth";
  reader.finish();
  if (!reader.ok()) return;
  if (function.time.size() != function.value.size()) {
    reader.error_at("values",
                    "'values' in " + what + " must be " + std::to_string(function.time.size()) +
                        ", one for each time, got " + std::to_string(function.value.size()));
  }
  const auto late = std::ranges::adjacent_find(function.time, std::greater_equal<>());
  if (late == function.time.end()) return;
  reader.error_at("at_s", "'at_s' in " + what + " must grow from each time to the next, got " +
                              config::number_text(*late) + " before " +
                              config::number_text(*(late + 1)));
}

std::string point_text(const Vec3& point, int space) {
  std::string text;
  for (int axis = 0; axis < space; ++axis) {
    text += (axis == 0 ? "" : ", ") + config::number_text(point[axis]);
  }
  return space == 1 ? text : "[" + text + "]";
}

/// The value at 0 s must be one to begin with.
void check_start_value(MappingReader& reader, const char* key, int space, DriveSpec& spec) {
  if (!is_of_time(spec.function)) return;
  spec.start = value_at(spec.function, 0.0);
  const std::string what = reader.name_of(key);
  if (!spec.start.allFinite()) {
    reader.error_at(key, what + " is no finite number at 0 s");
  } else if (spec.kind != DriveSpec::Kind::kForce && spec.start.cwiseAbs().maxCoeff() > kFarthest) {
    reader.error_at(key, what + " begins farther than 1e6 m away");
  } else if (spec.kind == DriveSpec::Kind::kDisplacement && spec.start.norm() > kSamePlace) {
    reader.error_at(
        key, what + " must be 0 at 0 s, where the matter is, got " + point_text(spec.start, space),
        "subtract that, or put the matter there");
  }
}

void drive_position(const DriveSpec& spec, MappingReader& reader, GeneratedMatter& matter) {
  const bool is_displacement = spec.kind == DriveSpec::Kind::kDisplacement;
  if (!is_displacement && matter.mats.size() != 1) {
    reader.error_at("driven",
                    "'position_m' drives one MAT, " + reader.what() + " has " +
                        std::to_string(matter.mats.size()),
                    "write displacement_m: it moves all of them alike");
    return;
  }
  for (std::uint32_t i = 0; i < matter.mats.size(); ++i) {
    engine::Mat& mat = matter.mats[i];
    if (!is_displacement && (mat.position - spec.start).norm() > kSamePlace) {
      reader.error_at("at_m", "'at_m' in " + reader.what() +
                                  " must be where 'position_m' is at 0 s, or be left out");
      return;
    }
    const Vec3 origin = is_displacement ? mat.position : Vec3(Vec3::Zero());
    mat = {MatKind::kPort, 0.0, origin + spec.start, Vec3::Zero()};
    matter.drives.push_back({i, 0, false, origin});
  }
}

void drive_force(const DriveSpec& spec, MappingReader& reader, GeneratedMatter& matter) {
  for (std::uint32_t i = 0; i < matter.mats.size(); ++i) {
    const engine::Mat& mat = matter.mats[i];
    if (mat.kind != MatKind::kMass) continue;
    matter.drives.push_back({i, 0, true});
    if (reader.ok()) check_force_there(spec.function, {0.0, mat.position, mat.velocity}, reader);
  }
  if (matter.drives.empty()) {
    reader.error_at("driven", "'force_n' drives masses, " + reader.what() + " has none");
  }
}

}  // namespace

void check_force_there(const TimeFunction& function, const engine::FunctionPoint& start,
                       MappingReader& reader) {
  if (asks_for_variable(function) || value_at(function, start).allFinite()) return;
  reader.error_at("driven", "'force_n' of " + reader.what() +
                                " is no finite number at 0 s, where a mass of it begins");
}

std::optional<DriveSpec> read_driven(MappingReader& reader, int space,
                                     const std::set<std::string>& signals, Problems& problems) {
  const Value section = reader.optional_mapping("driven");
  if (!section.exists()) return std::nullopt;
  const std::size_t errors_before = problems.error_count();
  MappingReader driven(section, "'driven' of " + reader.what(), problems);
  const std::vector<FormulaName> all_names = names_of_force(space);
  const bool pushes = driven.has("force_n");
  const std::span<const FormulaName> names =
      std::span(all_names).first(pushes ? all_names.size() : 1);
  const ParameterValues parameters = read_formula_parameters(
      driven, names, pushes ? "formulas of forces" : "formulas of time", problems);
  DriveSpec spec;
  AskedOutside outside{signals, spec.references};
  const char* written = nullptr;
  for (const DriveKey& known : kDriveKeys) {
    const Value value = driven.optional_value(known.key);
    if (!value.exists()) continue;
    if (written != nullptr) {
      driven.error_at(known.key, "either '" + std::string(written) + "' or '" + known.key +
                                     "' can be given in " + driven.what());
      break;
    }
    written = known.key;
    spec.kind = known.kind;
    const std::string what = driven.name_of(known.key);
    if (value.kind() == Value::Kind::kMapping) {
      read_table(value, what, space, spec.function, problems);
    } else {
      const bool is_force = known.kind == DriveSpec::Kind::kForce;
      spec.function.formula =
          read_axis_formulas(value, what, space, is_force ? names : names.first(1), parameters,
                             ", or a table", problems, is_force ? &outside : nullptr);
    }
  }
  driven.finish();
  if (written == nullptr && problems.error_count() == errors_before) {
    reader.error_at("driven", driven.what() + " needs position_m, displacement_m or force_n");
  }
  if (problems.error_count() == errors_before) check_start_value(driven, written, space, spec);
  if (problems.error_count() != errors_before) return std::nullopt;
  parameters.warn_of_unused(driven.optional_value("parameters"), driven.what(), problems);
  return spec;
}

void drive(const DriveSpec& spec, MappingReader& reader, GeneratedMatter& matter) {
  if (matter.mats.empty()) return;  // after a problem
  if (!matter.surfaces.empty() && spec.kind != DriveSpec::Kind::kDisplacement) {
    reader.error_at("driven", "a surface follows displacement_m");
    return;
  }
  if (spec.kind == DriveSpec::Kind::kForce) {
    drive_force(spec, reader, matter);
  } else {
    drive_position(spec, reader, matter);
  }
  if (matter.drives.empty()) return;
  matter.time_functions.push_back(spec.function);
  matter.references = spec.references;
}

}  // namespace cordis::scene
