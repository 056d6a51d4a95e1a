// sim_node/scene/liaisons/law.cpp
#include "sim_node/scene/liaisons/law.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

engine::Table read_table(LawSource& source, const char* argument) {
  const std::size_t errors_before = source.problems.error_count();
  const std::vector<double> at = read_numbers(source, argument);
  engine::Table table(at, read_numbers(source, "force_n"));
  if (source.problems.error_count() != errors_before) return table;

  const std::string name = std::string("'") + argument + "' in " + source.reader.what();
  if (at.empty()) source.reader.error_at(argument, name + " must not be empty");
  if (at.size() != table.value().size()) {
    source.reader.error_at("force_n", "'force_n' in " + source.reader.what() +
                                          " must have one number for each of '" + argument + "', " +
                                          std::to_string(at.size()) + ", got " +
                                          std::to_string(table.value().size()));
  }
  const auto turn = std::adjacent_find(at.begin(), at.end(), std::greater_equal<>());
  if (turn != at.end()) {
    const auto points = source.reader.optional_value(argument).items();
    source.problems.error(points[static_cast<std::size_t>(turn - at.begin()) + 1].place(),
                          name + " must ascend, got " + config::number_text(turn[1]) + " after " +
                              config::number_text(turn[0]));
  }
  return table;
}

engine::Power read_power(LawSource& source) {
  engine::Power power;
  power.coefficient = source.required("coefficient");
  power.exponent = source.required("exponent", Range::between(0.0, engine::kMaxExponent));
  if (2.0 * power.exponent != std::floor(2.0 * power.exponent)) {
    source.reader.error_at("exponent",
                           "'exponent' in " + source.reader.what() +
                               " must be a multiple of 0.5, got " +
                               config::number_text(power.exponent),
                           "give any other power as a table");
  }
  return power;
}

engine::LennardJones read_lennard_jones(LawSource& source) {
  constexpr double kSmallest = 1.0e-12;  // its 12th power is still a number
  engine::LennardJones law;
  law.well_depth = source.required("depth_j", Range::not_negative());
  law.diameter = source.required("diameter_m", Range::between(kSmallest, 1.0 / kSmallest));
  law.cutoff = optional_formula(source.reader, "cut_m", 0.0, Range::positive(), source.parameters,
                                source.problems);
  return law;
}

engine::Rings read_rings(LawSource& source) {
  engine::Rings law;
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
  return law;
}

/// Reads the key of a law. @param argument  key of the points of a table
Law read_law(config::MappingReader& reader, const char* key, const char* argument,
             const std::vector<std::string>& kinds, const ParameterValues& parameters,
             Problems& problems) {
  const Value value = reader.optional_value(key);
  const std::string what = std::string(key) + " of " + reader.what();
  if (!value.exists()) return {};
  if (value.kind() == Value::Kind::kScalar) {
    std::optional<engine::Program> program = compile_law(value, what, parameters, problems);
    return program ? Law(engine::Expression{std::move(*program)}) : Law();
  }
  Law law;
  LawSource source{config::MappingReader(value, what, problems), parameters, problems};
  const std::string kind = source.reader.required_choice("kind", kinds);
  if (!source.reader.ok()) return law;
  if (kind == "table") law = read_table(source, argument);
  if (kind == "power") law = read_power(source);
  if (kind == "lennard_jones") law = read_lennard_jones(source);
  if (kind == "rings") law = read_rings(source);
  source.reader.finish();
  return law;
}

}  // namespace

engine::Law read_elasticity(config::MappingReader& reader, const ParameterValues& parameters,
                            Problems& problems) {
  return read_law(reader, "elasticity", "at_m", {"table", "power", "lennard_jones", "rings"},
                  parameters, problems);
}

engine::Law read_dissipation(config::MappingReader& reader, const ParameterValues& parameters,
                             Problems& problems) {
  return read_law(reader, "dissipation", "at_m_per_s", {"table", "power"}, parameters, problems);
}

}  // namespace cordis::scene
