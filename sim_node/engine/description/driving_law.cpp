// sim_node/engine/description/driving_law.cpp
#include "sim_node/engine/description/driving_law.h"

#include <algorithm>
#include <variant>

namespace cordis::engine {
namespace {

bool may_push_along(const Law& dissipation) noexcept {
  if (std::holds_alternative<Expression>(dissipation)) return true;
  if (const auto* power = std::get_if<Power>(&dissipation)) return power->coefficient < 0.0;
  const auto* table = std::get_if<Table>(&dissipation);
  if (table == nullptr) return false;
  if (viscous_tension(dissipation, LawPoint{}) != 0.0) return true;
  for (std::size_t i = 0; i < table->argument().size(); ++i) {
    if (table->argument()[i] * table->value()[i] < 0.0) return true;
  }
  return false;
}

bool may_drive(const LinkState& state) noexcept {
  const auto* expression = std::get_if<Expression>(&state.elasticity);
  const bool asks_for_speed = expression != nullptr && !expression->is_potential();
  return asks_for_speed || may_push_along(state.dissipation);
}

}  // namespace

bool may_drive(const StateMachine& state_machine) noexcept {
  return std::any_of(state_machine.states.begin(), state_machine.states.end(),
                     [](const LinkState& state) { return may_drive(state); });
}

}  // namespace cordis::engine
