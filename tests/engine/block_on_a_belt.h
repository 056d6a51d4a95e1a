// tests/engine/block_on_a_belt.h -- stick and slip of a block that a spring holds.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {

/// A block on a belt: stuck to it by a stiff spring up to the static threshold, then dragged by
/// the constant kinetic force until it is as fast as the belt, MAT 2.
inline NetworkDescription block_on_a_belt(const nlohmann::json& params, double step) {
  LinkState slipping;
  slipping.dissipation = power_law(number(params["Fk"]), 0.0);
  const double mass_kg = number(params["m"]);
  const double hook = 1e5 * number(params["k"]);
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {fixed(Vec3::Zero()), mass(mass_kg, Vec3::Zero(), Vec3(number(params["V"]), 0, 0)),
                port(Vec3::Zero())};
  scene.links = {{0, 1, number(params["k"]), 0.0, 0.0}};
  scene.state_machines = {Behaving()
                              .state(hook, 2.0 * std::sqrt(hook * mass_kg))
                              .exit(size(q(Quantity::kForce)) > number(params["Fs"]), 1)
                              .state(slipping)
                              .exit(q(Quantity::kSpeed) >= 0.0, 0, RestRule::kHere)
                              .state_machine};
  scene.state_links = {{2, 1, 0, 0.0}};
  return scene;
}

}  // namespace cordis::test
