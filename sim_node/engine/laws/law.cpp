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

}  // namespace

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
    case Law::Kind::kFunction:
      return require(law.function != nullptr, name + ": function", "given");
  }
  require(false, name + ": kind", "a known one");
}

void check_dissipation(const Law& law, const std::string& name) {
  require(law.kind != Law::Kind::kLennardJones && law.kind != Law::Kind::kRings, name + ": kind",
          "a function of the speed, not of the distance");
  check_elasticity(law, name);
}

}  // namespace cordis::engine
