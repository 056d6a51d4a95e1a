// sim_node/engine/laws/law.cpp
#include "sim_node/engine/laws/law.h"

#include <type_traits>

#include "node/assert.h"
#include "sim_node/engine/core/require.h"
#include "sim_node/engine/laws/scalar_tension.h"

namespace cordis::engine {
namespace {

/// False for a table or an expression that check_elasticity would refuse because it holds nothing.
bool has_content(const Law& law) noexcept {
  if (const auto* table = std::get_if<Table>(&law)) {
    return !table->argument().empty() && table->argument().size() == table->value().size();
  }
  const auto* expression = std::get_if<Expression>(&law);
  return expression == nullptr || !expression->program.empty();
}

}  // namespace

LawArgument argument_of(const Law& law) noexcept {
  return std::visit([](const auto& alternative) { return alternative.kArgument; }, law);
}

bool stores_energy(const Law& law) noexcept {
  return std::visit([](const auto& alternative) { return alternative.kStoresEnergy; }, law);
}

void check_elasticity(const Law& law, const std::string& name, std::size_t variable_count) {
  const auto check = [&]<class Type>(const Type& alternative) {
    if constexpr (std::is_same_v<Type, Expression>) {
      alternative.check(name, variable_count);
    } else {
      alternative.check(name);
    }
  };
  std::visit(check, law);
}

void check_dissipation(const Law& law, const std::string& name, std::size_t variable_count) {
  require(argument_of(law) != LawArgument::kDistance, name + ": kind",
          "a function of the speed, not of the distance");
  check_elasticity(law, name, variable_count);
}

bool asks_for_variable(const Law& law) noexcept {
  const auto* expression = std::get_if<Expression>(&law);
  return expression != nullptr && asks_for_variable(expression->program);
}

bool is_product(const Law& law, Quantity of) noexcept {
  const auto* expression = std::get_if<Expression>(&law);
  return expression != nullptr && expression->factor_size(of) > 0;
}

double elastic_tension(const Law& law, const LawPoint& link) noexcept {
  CORDIS_ASSERT(has_content(law));
  return std::visit(
      [&](const auto& alternative) { return scalar_tension(alternative, link, link.elongation); },
      law);
}

double viscous_tension(const Law& law, const LawPoint& link) noexcept {
  CORDIS_ASSERT(has_content(law));
  return std::visit(
      [&](const auto& alternative) { return scalar_tension(alternative, link, link.speed); }, law);
}

double potential(const Law& law, const LawPoint& link) noexcept {
  const auto potential_of_type = [&]<class Type>(const Type& alternative) {
    if constexpr (std::is_same_v<Type, Expression>) {
      return alternative.potential(link);
    } else {
      return alternative.potential(link.distance, link.elongation);
    }
  };
  return std::visit(potential_of_type, law);
}

LawSlope largest_slope(const Law& law, const LawRange& range) noexcept {
  return std::visit([&](const auto& alternative) { return alternative.largest_slope(range); }, law);
}

double smallest_slope(const Law& law, double elongation) noexcept {
  return std::visit([&](const auto& alternative) { return alternative.smallest_slope(elongation); },
                    law);
}

double range_of(const Law& law) noexcept {
  return std::visit([](const auto& alternative) { return alternative.range(); }, law);
}

}  // namespace cordis::engine
