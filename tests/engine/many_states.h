// tests/engine/many_states.h -- a network in which links of every kind change state all the time.
#pragma once

#include <cstdint>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {

inline engine::Law table_law() {
  return engine::Table{{-0.2, -0.05, 0.0, 0.1, 0.3}, {-9.0, -1.0, 0.0, 2.5, 3.0}};
}

inline engine::Law power_law(double coefficient, double exponent) {
  return engine::Power{coefficient, exponent};
}

inline engine::Law lennard_jones_law(double well_depth, double diameter, double cutoff) {
  return engine::LennardJones{well_depth, diameter, cutoff};
}

inline engine::Law ring_law() {
  return engine::Rings{{{40.0, 0.2}, {-15.0, 0.4}}};
}

/// 30 e + 100 e^3 + (m_a + m_b) v.
inline engine::Law cubic_law() {
  const Term e = q(Quantity::kElongation);
  const Term masses = q(Quantity::kMassA) + q(Quantity::kMassB);
  return expression_law(30.0 * e + 100.0 * e * e * e + masses * q(Quantity::kSpeed));
}

/// Six states, one law each, left for the next one after conditions of different kinds.
inline StateMachine state_machine_of_many_states() {
  const auto with = [](engine::Law elasticity, engine::Law dissipation = {}) {
    LinkState state;
    state.viscosity = 0.05;
    state.elasticity = std::move(elasticity);
    state.dissipation = std::move(dissipation);
    return state;
  };
  LinkState thread = with(power_law(200.0, 1.5), power_law(0.02, 2.0));
  thread.pushes = false;
  LinkState limited = with(cubic_law());
  limited.force_limit = 4.0;
  return Behaving()
      .state(20.0, 0.1)
      .exit(q(Quantity::kAge) > 0.02 + q(Quantity::kMassA) * 0.1, 1)
      .state(with(table_law(), table_law()))
      .exit(both(q(Quantity::kAge) > 0.01,
                 one(Operation::kRising, size(q(Quantity::kSpeed)) + q(Quantity::kSlip), 1)),
            2, RestRule::kHere)
      .exit(size(q(Quantity::kForce)) > 8.0, 3)
      .state(thread)
      .exit_to_rest(q(Quantity::kImpulse) > 0.003, 3,
                    q(Quantity::kRestLength) + 0.5 * q(Quantity::kElongation))
      .exit(q(Quantity::kAge) > 0.03, 4)
      .state(limited)
      .exit(one(Operation::kFalling, q(Quantity::kSpeed), 0), 4)
      .state(with(lennard_jones_law(1e-3, 0.1, 0.4)))
      .exit(q(Quantity::kAge) > 0.015, 5)
      .state(with(ring_law()))
      .exit(either(q(Quantity::kSpeedX) > q(Quantity::kSpeedY) * 2.0, q(Quantity::kAge) > 0.02), 0,
            RestRule::kHere)
      .state_machine;
}

/// 20 masses, joined by 75 links of many states, by linear ones, and by a damper; a port stirs.
inline NetworkDescription network_of_many_states(int dimension) {
  NetworkDescription scene = free_cluster(20, 95, 0.1, dimension);
  scene.medium_viscosity = 0.2;  // takes what the changes of state bring in
  scene.mats.push_back(port(Vec3::Zero()));
  scene.state_machines = {state_machine_of_many_states(), Behaving().state(0.0, 0.3).state_machine};
  for (std::size_t l = 20; l < 95; ++l) {
    const Link& link = scene.links[l];
    scene.state_links.push_back({link.mat_a, link.mat_b, l % 9 == 0 ? 1U : 0U, link.rest_length});
  }
  scene.links.resize(20);
  scene.state_links.push_back({20, 3, 0, 0.2});
  return scene;
}

inline void stir(World& world, int step_count) {
  for (int n = 0; n < step_count; ++n) {
    const auto phase = static_cast<double>(world.step_count() % 200) / 200.0;
    world.impose_position(20, Vec3(phase * (1.0 - phase), 0.1 * phase, 0.0));
    world.step();
  }
}

}  // namespace cordis::test
