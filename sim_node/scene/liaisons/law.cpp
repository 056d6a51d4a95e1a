// sim_node/scene/liaisons/law.cpp
#include "sim_node/scene/liaisons/law.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace cordis::scene {

namespace {

using config::Problems;
using config::Range;
using config::Value;
using engine::Law;

/// What a law is read from.
struct LawSource {
  config::MappingReader reader;
  const ParameterValues& parameters;
  Problems& problems;

  double required(const char* key, Range range = {}) {
    return required_formula(reader, key, range, parameters, problems);
  }
};

std::vector<double> read_numbers(LawSource& source, const char* key) {
  std::vector<double> numbers;
  for (const Value& item : source.reader.required_sequence(key).items()) {
    numbers.push_back(read_formula(item, std::string("'") + key + "' in " + source.reader.what(),
                                   0.0, {}, source.parameters, source.problems));
  }
  return numbers;
}

void read_table(LawSource& source, Law& law, const char* argument) {
  const std::size_t errors_before = source.problems.error_count();
  law.kind = Law::Kind::kTable;
  law.table.at = read_numbers(source, argument);
  law.table.value = read_numbers(source, "force_n");
  if (source.problems.error_count() != errors_before) return;

  const std::string name = std::string("'") + argument + "' in " + source.reader.what();
  if (law.table.at.empty()) source.reader.error_at(argument, name + " must not be empty");
  if (law.table.at.size() != law.table.value.size()) {
    source.reader.error_at("force_n", "'force_n' in " + source.reader.what() +
                                          " must have one number for each of '" + argument + "', " +
                                          std::to_string(law.table.at.size()) + ", got " +
                                          std::to_string(law.table.value.size()));
  }
  const Value points = source.reader.optional_value(argument);
  for (std::size_t i = 1; i < law.table.at.size(); ++i) {
    if (law.table.at[i] > law.table.at[i - 1]) continue;
    source.problems.error(points.items()[i].place(),
                          name + " must ascend, got " + config::number_text(law.table.at[i]) +
                              " after " + config::number_text(law.table.at[i - 1]));
    return;
  }
}

void read_power(LawSource& source, Law& law) {
  law.kind = Law::Kind::kPower;
  law.coefficient = source.required("coefficient");
  law.exponent = source.required("exponent", Range::between(0.0, engine::kMaxExponent));
  if (2.0 * law.exponent == std::floor(2.0 * law.exponent)) return;
  source.reader.error_at("exponent",
                         "'exponent' in " + source.reader.what() +
                             " must be a multiple of 0.5, got " + config::number_text(law.exponent),
                         "give any other power as a table");
}

void read_lennard_jones(LawSource& source, Law& law) {
  law.kind = Law::Kind::kLennardJones;
  constexpr double kSmallest = 1.0e-12;  // its 12th power is still a number
  law.depth = source.required("depth_j", Range::not_negative());
  law.diameter = source.required("diameter_m", Range::between(kSmallest, 1.0 / kSmallest));
  law.cut = optional_formula(source.reader, "cut_m", 0.0, Range::positive(), source.parameters,
                             source.problems);
}

void read_rings(LawSource& source, Law& law) {
  law.kind = Law::Kind::kRings;
  const Value rings = source.reader.required_sequence("rings");
  if (rings.exists() && rings.items().empty())
    source.reader.error_at("rings", "'rings' in " + source.reader.what() + " must not be empty");
  for (const Value& item : rings.items()) {
    config::MappingReader reader(item, "ring of " + source.reader.what(), source.problems);
    engine::Ring ring;
    ring.stiffness =
        required_formula(reader, "stiffness_n_per_m", {}, source.parameters, source.problems);
    ring.radius =
        required_formula(reader, "radius_m", Range::positive(), source.parameters, source.problems);
    reader.finish();
    law.rings.push_back(ring);
  }
}

Law read_expression(const Value& text, const std::string& what, const ParameterValues& parameters,
                    Problems& problems) {
  Law law;
  std::optional<engine::Program> expression = compile_law(text, what, parameters, problems);
  if (!expression) return law;
  law.kind = Law::Kind::kExpression;
  law.expression = std::move(*expression);
  return law;
}

}  // namespace

engine::Law read_elasticity(config::MappingReader& reader, const ParameterValues& parameters,
                            Problems& problems) {
  const Value value = reader.optional_value("elasticity");
  const std::string what = "elasticity of " + reader.what();
  if (!value.exists()) return {};
  if (value.kind() == Value::Kind::kScalar)
    return read_expression(value, what, parameters, problems);

  Law law;
  LawSource source{config::MappingReader(value, what, problems), parameters, problems};
  const std::string kind =
      source.reader.required_choice("kind", {"table", "power", "lennard_jones", "rings"});
  if (!source.reader.ok()) return law;
  if (kind == "table") read_table(source, law, "at_m");
  if (kind == "power") read_power(source, law);
  if (kind == "lennard_jones") read_lennard_jones(source, law);
  if (kind == "rings") read_rings(source, law);
  source.reader.finish();
  return law;
}

engine::Law read_dissipation(config::MappingReader& reader, const ParameterValues& parameters,
                             Problems& problems) {
  const Value value = reader.optional_value("dissipation");
  const std::string what = "dissipation of " + reader.what();
  if (!value.exists()) return {};
  if (value.kind() == Value::Kind::kScalar)
    return read_expression(value, what, parameters, problems);

  Law law;
  LawSource source{config::MappingReader(value, what, problems), parameters, problems};
  const std::string kind = source.reader.required_choice("kind", {"table", "power"});
  if (!source.reader.ok()) return law;
  if (kind == "table") read_table(source, law, "at_m_per_s");
  if (kind == "power") read_power(source, law);
  source.reader.finish();
  return law;
}

double reach_of(const engine::Law& law) noexcept {
  if (law.kind == Law::Kind::kLennardJones) return law.cut;
  double reach = 0.0;
  if (law.kind == Law::Kind::kRings) {
    for (const engine::Ring& ring : law.rings) reach = std::max(reach, ring.radius);
  }
  return reach;
}

}  // namespace cordis::scene
