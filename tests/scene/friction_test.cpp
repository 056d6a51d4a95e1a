// tests/scene/friction_test.cpp -- friction as a scene writes it.
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

constexpr const char* kMatter = R"(matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [[0, 1], [1, 1]]}
  floor: {kind: plane, at_m: [0, 0], normal: y}
)";

TEST(FrictionOfALiaison, StandsBesideItsStates) {
  const Scene scene = sound_scene(2, std::string(kMatter) + R"(liaisons:
  rough: {parameters: {mu: 0.5}, stiffness_n_per_m: 600, pulls: false, range: rest,
          friction: {static: mu, kinetic: 0.8 * mu, stiffness_n_per_m: 300, viscosity_n_s_per_m: 2}}
  even: {like: rough, friction: {static: 0.25, kinetic: 0.5 * mu}}
links:
  - {liaison: rough, between_sets: [balls, floor]}
  - {liaison: rough, within: balls, mu: 1}
  - {liaison: even, within: balls}
)");

  const auto& machines = scene.network.state_machines;
  ASSERT_EQ(scene.network.sets.size(), 3u);
  const engine::Friction& floor = machines[scene.network.sets[0].state_machine].friction;
  EXPECT_EQ(floor.static_coefficient, 0.5);
  EXPECT_EQ(floor.kinetic_coefficient, 0.4);
  EXPECT_EQ(floor.stiffness, 300.0);
  EXPECT_EQ(floor.viscosity, 2.0);
  EXPECT_EQ(machines[scene.network.sets[1].state_machine].friction.static_coefficient, 1.0);
  const engine::Friction& even = machines[scene.network.sets[2].state_machine].friction;
  EXPECT_EQ(even.static_coefficient, 0.25);
  EXPECT_EQ(even.stiffness, 300.0);
  EXPECT_NO_THROW(engine::Network{scene.network});
}

TEST(FrictionOfALiaison, IsTheSameAtRestAndInMotionUnlessWritten) {
  const Scene scene = sound_scene(2, std::string(kMatter) + R"(liaisons:
  rough: {stiffness_n_per_m: 600, range: rest, friction: {static: 0.3, stiffness_n_per_m: 300}}
links:
  - {liaison: rough, between_sets: [balls, floor]}
)");
  const engine::Friction& friction = scene.network.state_machines[0].friction;
  EXPECT_EQ(friction.kinetic_coefficient, 0.3);
  EXPECT_EQ(friction.viscosity, 0.0);
}

TEST(FrictionOfALiaison, IsAnotherOneInAStateThatHasItsOwn) {
  const Scene scene = sound_scene(2, std::string(kMatter) + R"(liaisons:
  grip:
    friction: {static: 0.5, stiffness_n_per_m: 300, viscosity_n_s_per_m: 2}
    states:
      holds: {stiffness_n_per_m: 600, pulls: false, exits: [{to: slides, when: slip_m > 0.001}]}
      slides:
        stiffness_n_per_m: 600
        pulls: false
        friction: {static: 0.3, kinetic: 0.2, viscosity_n_s_per_m: 1}
        exits: [{to: free, when: normal_force_n > 3}]
      free: {stiffness_n_per_m: 600, pulls: false, friction: none, exits: [{to: holds, when: age_s > 1}]}
links:
  - {liaison: grip, between_sets: [balls, floor], rest: radii, range_m: 0.11}
)");

  const engine::StateMachine& grip = scene.network.state_machines[0];
  EXPECT_FALSE(grip.states[0].friction);
  EXPECT_EQ(*grip.states[1].friction, (engine::Friction{0.3, 0.2, 300.0, 1.0}));
  EXPECT_FALSE(grip.states[2].friction->acts());
  EXPECT_EQ(grip.exits[0].triggered, engine::Quantity::kSlid);
  EXPECT_EQ(grip.exits[1].triggered, engine::Quantity::kForce);
  engine::LinkQuantities link{};
  link[static_cast<std::size_t>(engine::Quantity::kForce)] = -3.5;
  EXPECT_EQ(engine::value_of(grip.exits[1].when, link), 1.0);
  link[static_cast<std::size_t>(engine::Quantity::kForce)] = 3.5;
  EXPECT_EQ(engine::value_of(grip.exits[1].when, link), 0.0);
}

class BadFriction : public testing::TestWithParam<BadScene> {};

TEST_P(BadFriction, IsAProblemOfItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Friction, BadFriction,
    testing::Values(
        BadScene{kHead2,
                 R"(liaisons:
  a: {pulls: false, friction: ^0.5}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'friction' in liaison 'a' must be a mapping of keys, got '0.5'",
                 "for example friction: {static: 0.5, stiffness_n_per_m: 3000, "
                 "viscosity_n_s_per_m: 2}"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {pulls: false, friction: ^{kinetic: 0.1, stiffness_n_per_m: 3}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "missing key 'static' in friction of liaison 'a'",
                 "for example friction: {static: 0.5, stiffness_n_per_m: 3000, "
                 "viscosity_n_s_per_m: 2}"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {kind: spring, stiffness_n_per_m: 9, friction: ^{static: 0.1, stiffness_n_per_m: 3}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "a spring has no 'friction'",
                 "leave 'kind' out: a liaison with friction is a state_machine"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {pulls: false, range: rest, stiffness_n_per_m: 9}
matter: {m: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [[0, 0], [1, 0]]}}
links:
  - {liaison: a, within: m, friction: ^0.5}
)",
                 "a link has no 'friction', its liaison has",
                 "write in the liaison friction: {static: 0.5, stiffness_n_per_m: 3000, "
                 "viscosity_n_s_per_m: 2}"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {pulls: false, friction: ^{static: 0.1}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "missing key 'stiffness_n_per_m' in friction of liaison 'a'", ""},
        BadScene{kHead2,
                 R"(liaisons:
  a: {friction: {static: 0.1, kinetic: ^0.2, stiffness_n_per_m: 1}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'kinetic' in friction of liaison 'a' must not be above 'static'", ""},
        BadScene{kHead2,
                 R"(liaisons:
  a: {friction: {static: 0.1, stiffness_n_per_m: ^0}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'stiffness_n_per_m' in friction of liaison 'a' must be > 0, got 0", ""},
        BadScene{kHead2,
                 R"(liaisons:
  a: {friction: {static: 0.1, stiffness_n_per_m: 1,
      viscosity_n_s_per_m: ^1e308}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'viscosity_n_s_per_m' in friction of liaison 'a' must be between 0 and 1e+300, "
                 "got 1e308",
                 ""},
        BadScene{kHead2,
                 R"(liaisons:
  a: {pulls: false, viscosity_n_s_per_m: ^1e308}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'viscosity_n_s_per_m' in liaison 'a' must be between 0 and 1e+300, got 1e308",
                 ""},
        BadScene{kHead2,
                 R"(liaisons:
  r: {pulls: false, friction: {static: 0.1, stiffness_n_per_m: 1}}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: ^r, between: ["a[0]", "a[1]"]}
)",
                 "friction acts between the members of sets, not in a link",
                 "write between_sets: [a, b], also for one MAT each"},
        BadScene{kHead2,
                 R"(liaisons:
  r: {pulls: false, friction: {static: 0.1, stiffness_n_per_m: 1}}
matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], liaison: ^r}
)",
                 "friction acts in liaisons of sets, not between neighbours", ""},
        BadScene{kHead2,
                 R"(liaisons:
  a: {states: {x: {pulls: false, exits: [{to: x, when: ^slip_m > 1}]}}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "a condition of liaison 'a' asks for 'slip_m', which has no friction",
                 "give it 'friction', or ask for slip_m_per_s"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {states: {x: {pulls: false, exits: [{to: x, when: age_s > 1, rest: ^slip_m + 1}]}}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "a rest length of liaison 'a' asks for 'slip_m', which has no friction",
                 "give it 'friction', or ask for slip_m_per_s"},
        BadScene{kHead2,
                 R"(liaisons:
  a: {states: {x: {pulls: false, friction: ^some}}}
matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}
)",
                 "'friction' in state 'x' of liaison 'a' must be a mapping of keys, got 'some'",
                 "for example friction: {static: 0.5, stiffness_n_per_m: 3000, "
                 "viscosity_n_s_per_m: 2}"},
        BadScene{kHead1,
                 R"(liaisons:
  r: {pulls: false, friction: {static: 0.1, stiffness_n_per_m: 1}}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 1]}
links:
  - {liaison: ^r, within: a, rest_m: 1, range_m: 1}
)",
                 "space 1 has no direction to slide in, so there is no friction",
                 "take a liaison without 'friction', or 'space: 2'"}));

}  // namespace
}  // namespace cordis::scene
