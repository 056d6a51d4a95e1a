// sim_node/engine/laws/law.cpp
#include "sim_node/engine/laws/law.h"

#include <cmath>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {
namespace {

void check_table(const Table& table, const std::string& name) {
  require(!table.at.empty(), name + ": table", "one of at least 1 point");
  require(table.at.size() == table.value.size(), name + ": table", "as long as its values");
  for (std::size_t i = 0; i < table.at.size(); ++i) {
    require(std::isfinite(table.at[i]) && std::isfinite(table.value[i]), name + ": table",
            "of finite points");
    require(i == 0 || table.at[i - 1] < table.at[i], name + ": points of the table",
            "strictly ascending");
    if (i == 0) continue;
    const double slope = (table.value[i] - table.value[i - 1]) / (table.at[i] - table.at[i - 1]);
    require(std::isfinite(slope), name + ": slope of the table", "finite");
  }
}

void check_power(const Law& law, const std::string& name) {
  require(std::isfinite(law.coefficient), name + ": coefficient", "finite");
  require(law.exponent >= 0.0 && law.exponent <= kMaxExponent &&
              2.0 * law.exponent == std::floor(2.0 * law.exponent),
          name + ": exponent",
          "a multiple of 0.5 from 0 to 16, which is computed by multiplication and square root "
          "alone; give any other power as a table");
}

void check_lennard_jones(const Law& law, const std::string& name) {
  require(is_finite_and_at_least_zero(law.depth), name + ": depth", "finite and >= 0");
  require(std::isfinite(law.diameter) && law.diameter > 0.0, name + ": diameter", "finite and > 0");
  require(is_finite_and_at_least_zero(law.cut), name + ": cut", "finite and >= 0");
  const double cube = law.diameter * law.diameter * law.diameter;
  const double twelfth = cube * cube * cube * cube;
  require(std::isnormal(twelfth) && std::isfinite(law.depth * twelfth), name + ": diameter",
          "within the range of its 12th power");
}

void check_rings(const Law& law, const std::string& name) {
  require(!law.rings.empty(), name + ": number of rings", "at least 1");
  for (const Ring& ring : law.rings) {
    require(std::isfinite(ring.stiffness), name + ": stiffness of a ring", "finite");
    require(std::isfinite(ring.radius) && ring.radius > 0.0, name + ": radius of a ring",
            "finite and > 0");
  }
}

void check_expression(const Program& expression, const std::string& name) {
  check_program(expression, name);
  require(!has_edge(expression), name, "one without rising and falling");
  for (const Instruction& instruction : expression.code) {
    require(instruction.operation != Operation::kQuantity || is_known_to_laws(instruction.quantity),
            name + ": quantity", "distance, elongation, speed, or the mass of an end");
  }
}

}  // namespace

bool is_known_to_laws(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::kDistance:
    case Quantity::kElongation:
    case Quantity::kSpeed:
    case Quantity::kMassA:
    case Quantity::kMassB:
      return true;
    default:
      return false;
  }
}

double expression_pull(const Program& expression, double distance, double elongation, double speed,
                       double mass_a, double mass_b) noexcept {
  LinkQuantities link{};
  link[static_cast<std::size_t>(Quantity::kDistance)] = distance;
  link[static_cast<std::size_t>(Quantity::kElongation)] = elongation;
  link[static_cast<std::size_t>(Quantity::kSpeed)] = speed;
  link[static_cast<std::size_t>(Quantity::kMassA)] = mass_a;
  link[static_cast<std::size_t>(Quantity::kMassB)] = mass_b;
  const double pull = value_of(expression, link);
  return std::isfinite(pull) ? pull : 0.0;
}

void check_elasticity(const Law& law, const std::string& name) {
  switch (law.kind) {
    case Law::Kind::kNone:
      return;
    case Law::Kind::kTable:
      return check_table(law.table, name);
    case Law::Kind::kPower:
      return check_power(law, name);
    case Law::Kind::kLennardJones:
      return check_lennard_jones(law, name);
    case Law::Kind::kRings:
      return check_rings(law, name);
    case Law::Kind::kExpression:
      return check_expression(law.expression, name + ": expression");
  }
  require(false, name + ": kind", "a known one");
}

void check_dissipation(const Law& law, const std::string& name) {
  require(law.kind != Law::Kind::kLennardJones && law.kind != Law::Kind::kRings, name + ": kind",
          "a function of the speed, not of the distance");
  check_elasticity(law, name);
}

}  // namespace cordis::engine
