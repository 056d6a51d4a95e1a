// sim_node/scene/matter/start.cpp
#include "sim_node/scene/matter/start.h"

#include <algorithm>
#include <string>

#include "sim_node/scene/language/point.h"

namespace cordis::scene {

namespace {

using config::MappingReader;
using config::Value;
using engine::MatKind;
using engine::Vec3;

constexpr std::array<FormulaName, 5> kNamesOfStart{{{"index", engine::Quantity::kAge},
                                                    {"count", engine::Quantity::kDistance},
                                                    {"x_m", engine::Quantity::kSpeedX},
                                                    {"y_m", engine::Quantity::kSpeedY},
                                                    {"z_m", engine::Quantity::kSpeedZ}}};

/// What a formula of a start may ask for.
std::span<const FormulaName> names_in(int space) {
  return std::span(kNamesOfStart).first(2 + static_cast<std::size_t>(space));
}

/// The value of formulas at a MAT of an entry. The same bits everywhere.
Vec3 value_at(const AxisFormulas& formulas, const Vec3& place, std::size_t index,
              std::size_t count) {
  engine::LinkQuantities quantities{};
  const auto put = [&quantities](engine::Quantity quantity, double value) {
    quantities[static_cast<std::size_t>(quantity)] = value;
  };
  put(engine::Quantity::kAge, static_cast<double>(index));
  put(engine::Quantity::kDistance, static_cast<double>(count));
  put(engine::Quantity::kSpeedX, place.x());
  put(engine::Quantity::kSpeedY, place.y());
  put(engine::Quantity::kSpeedZ, place.z());
  Vec3 value = Vec3::Zero();
  for (std::size_t axis = 0; axis < formulas.size(); ++axis) {
    if (formulas[axis].empty()) continue;
    value[static_cast<int>(axis)] = value_of(formulas[axis], quantities);
  }
  return value;
}

Vec3 centre_of_mass(std::span<const engine::Mat> mats) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (const engine::Mat& mat : mats) {
    if (mat.kind != MatKind::kMass) continue;
    sum += mat.mass * mat.position;
    mass += mat.mass;
  }
  return mass > 0.0 ? Vec3(sum / mass) : sum;
}

/// A value of a formula that a MAT cannot start with is a problem. @return whether it can
bool check_value(const Vec3& value, const Vec3& bounded, const char* key, std::size_t index,
                 MappingReader& reader) {
  const std::string what = reader.name_of(key) + " at index " + std::to_string(index);
  if (!value.allFinite()) {
    reader.error_at(key, what + " is no finite number");
    return false;
  }
  if (bounded.cwiseAbs().maxCoeff() <= kFarthest) return true;
  reader.error_at(key, what + " is beyond 1e6");
  return false;
}

void displace(const AxisFormulas& formulas, MappingReader& reader, std::span<engine::Mat> mats) {
  for (std::size_t i = 0; i < mats.size(); ++i) {
    if (mats[i].kind != MatKind::kMass) continue;
    const Vec3 way = value_at(formulas, mats[i].position, i, mats.size());
    if (!check_value(way, mats[i].position + way, "displacement_m", i, reader)) return;
    mats[i].position += way;
  }
}

/// The velocity of each MAT, from its place. Nothing after a problem.
std::vector<Vec3> velocities(const StartSpec& spec, MappingReader& reader,
                             std::span<const engine::Mat> mats) {
  std::vector<Vec3> velocity = spec.velocity;
  if (velocity.size() == 1) velocity.resize(mats.size(), velocity.front());
  if (velocity.size() != mats.size()) {
    reader.error_at("velocity_m_per_s", reader.name_of("velocity_m_per_s") +
                                            " must be one for all or one for each of the " +
                                            std::to_string(mats.size()) + ", got " +
                                            std::to_string(velocity.size()));
    return {};
  }
  for (std::size_t i = 0; spec.velocity_of && i < mats.size(); ++i) {
    if (mats[i].kind != MatKind::kMass) continue;
    velocity[i] = value_at(*spec.velocity_of, mats[i].position, i, mats.size());
    if (!check_value(velocity[i], velocity[i], "velocity_m_per_s", i, reader)) return {};
  }
  return velocity;
}

/// True where a vector differs from 0.
bool is_any(std::span<const Vec3> vectors) {
  return std::ranges::any_of(vectors, [](const Vec3& vector) { return !vector.isZero(0.0); });
}

/// True if an entry cannot start as it says: it does not move, or follows a function.
bool contradicts(const StartSpec& spec, bool is_led, MappingReader& reader,
                 std::span<const engine::Mat> mats) {
  const bool has_mass =
      std::ranges::any_of(mats, [](const auto& mat) { return mat.kind == MatKind::kMass; });
  if (has_mass && !is_led) return false;
  const auto refuse = [&](bool is_written, const char* key, const char* what) {
    if (!is_written) return false;
    std::string text = is_led ? "a driven position has the " : "what is fixed has no ";
    text.append(what).append(is_led ? " of its function: " : ": ").append(reader.name_of(key));
    text.append(is_led ? " contradicts it" : " contradicts 'fixed'");
    reader.error_at(key, text);
    return true;
  };
  const bool moves = spec.velocity_of.has_value() || is_any(spec.velocity);
  bool refused = refuse(moves, "velocity_m_per_s", "velocity");
  refused = refuse(!spec.spin.isZero(0.0), "spin_rad_per_s", "spin") || refused;
  return refuse(spec.displacement_of.has_value(), "displacement_m", "displacement") || refused;
}

/// `spin_rad_per_s`: in 2-D a number, counter-clockwise, in 3-D a vector. Nothing turns in 1-D.
Vec3 read_spin(MappingReader& reader, int space) {
  reader.describe({.key = "spin_rad_per_s", .kind = config::KeyKind::kVector});
  if (space == 1) {
    if (!reader.has("spin_rad_per_s")) return Vec3::Zero();
    reader.optional_value("spin_rad_per_s");
    reader.error_at("spin_rad_per_s", "nothing turns in a scene of space 1");
    return Vec3::Zero();
  }
  if (space == 3) return optional_point(reader, "spin_rad_per_s", Vec3::Zero(), 3);
  const double turn =
      reader.optional_number("spin_rad_per_s", 0.0, config::Range::between(-kFarthest, kFarthest));
  return {0.0, 0.0, turn};
}

}  // namespace

StartMotion read_motion(MappingReader& reader, int space) {
  return {optional_point(reader, "velocity_m_per_s", Vec3::Zero(), space),
          read_spin(reader, space)};
}

bool add_motion(const StartMotion& motion, std::span<engine::Mat> mats) {
  const Vec3 centre = centre_of_mass(mats);
  bool has_mass = false;
  for (engine::Mat& mat : mats) {
    if (mat.kind != MatKind::kMass) continue;
    has_mass = true;
    mat.velocity += motion.velocity + cross(motion.spin, mat.position - centre);
  }
  return has_mass;
}

StartSpec read_start(MappingReader& reader, int space, bool for_each, config::Problems& problems) {
  StartSpec spec;
  spec.velocity = {Vec3::Zero()};
  using config::KeyKind;
  const KeyKind kind = for_each ? KeyKind::kFormulaVectors : KeyKind::kFormulaVector;
  reader.describe({.key = "velocity_m_per_s", .kind = kind});
  reader.describe({.key = "displacement_m", .kind = KeyKind::kFormulaVector});
  const Value velocity = reader.optional_value("velocity_m_per_s");
  spec.spin = read_spin(reader, space);
  const Value displacement = reader.optional_value("displacement_m");
  const bool is_formula = velocity.exists() && has_formula(velocity);
  if (velocity.exists() && !is_formula) {
    spec.velocity =
        for_each
            ? required_points(reader, "velocity_m_per_s", space, problems)
            : std::vector<Vec3>{optional_point(reader, "velocity_m_per_s", Vec3::Zero(), space)};
  }
  const std::size_t errors_before = problems.error_count();
  const std::span<const FormulaName> names = names_in(space);
  const ParameterValues parameters =
      read_formula_parameters(reader, names, "formulas of the start", problems);
  const auto read = [&](const Value& value, const char* key) {
    return read_axis_formulas(value, reader.name_of(key), space, names, parameters, "", problems);
  };
  if (is_formula) spec.velocity_of = read(velocity, "velocity_m_per_s");
  if (displacement.exists()) spec.displacement_of = read(displacement, "displacement_m");
  if (problems.error_count() != errors_before) return {{Vec3::Zero()}, {}, {}, spec.spin};
  parameters.warn_of_unused(reader.optional_value("parameters"), reader.what(), problems);
  return spec;
}

void start(const StartSpec& spec, bool is_led, int space, MappingReader& reader,
           GeneratedMatter& matter) {
  if (matter.mats.empty() || contradicts(spec, is_led, reader, matter.mats)) return;
  const std::vector<Vec3> velocity = velocities(spec, reader, matter.mats);
  if (velocity.empty()) return;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    if (matter.mats[i].kind == MatKind::kMass) matter.mats[i].velocity = velocity[i];
  }
  if (spec.displacement_of) displace(*spec.displacement_of, reader, matter.mats);
  if (space > 1 && !spec.spin.isZero(0.0)) {
    (void)add_motion({Vec3::Zero(), spec.spin}, matter.mats);  // there is a mass
  }
}

}  // namespace cordis::scene
