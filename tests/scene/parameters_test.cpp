// tests/scene/parameters_test.cpp
#include "sim_node/scene/parameters.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

constexpr const char* kScene =
    R"(liaisons:
  soft: {kind: spring_damper, parameters: {k: 3}, stiffness_n_per_m: 2 * k, viscosity_n_s_per_m: 1}
  late: {kind: maxwell, stiffness_n_per_m: 5, viscosity_n_s_per_m: 6}
  both: {parallel: [soft, late]}
  brittle:
    parameters: {length_m: 0.1, twice_m: 2 * length_m}
    states:
      whole: {stiffness_n_per_m: 10, exits: [{to: broken, when: elongation_m > twice_m}]}
      broken: {}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 1, at_m: [1, 0]}
  bar: {kind: string, count: 3, mass_kg: 1, from_m: [0, 1], to_m: [1, 1], stiffness_n_per_m: 7,
        viscosity_n_s_per_m: 8}
links:
  - {liaison: soft, between: [wall, bob]}
  - {liaison: soft, between: [wall, bob], k: 9, name: stiff}
  - {liaison: late, between: [wall, bob]}
  - {liaison: brittle, between: [wall, bob]}
  - {liaison: brittle, between: [wall, bob]}
  - {liaison: brittle, between: [wall, bob], length_m: 0.3, name: strong}
  - {liaison: brittle, within: bar, rest_m: 0.1, range_m: 0.2, name: glue}
  - {liaison: both, between: [wall, bob], name: solid}
)";

class ParametersOfAScene : public testing::Test {
 protected:
  /// The network after a change; nothing has changed after a problem.
  engine::NetworkDescription after(const std::string& name, const std::string& parameter,
                                   double value) {
    const Parameters::Outcome outcome = parameters.set(name, parameter, value);
    problem = outcome.problem;
    hint = outcome.hint;
    for (const Change& change : outcome.changes) apply(change, network);
    return network;
  }
  /// The elongation at which links of a state machine break.
  double limit_of(std::uint32_t state_machine) const {
    return network.state_machines[state_machine].exits[0].when.code[1].constant;
  }

  std::shared_ptr<const Scene> scene = std::make_shared<const Scene>(sound_scene(2, kScene));
  Parameters parameters{scene};
  engine::NetworkDescription network = scene->network;
  std::string problem;
  std::string hint;
};

TEST_F(ParametersOfAScene, OfALiaisonAreSetForLinksThatGiveNoneOfTheirOwn) {
  after("brittle", "length_m", 0.5);

  EXPECT_EQ(problem, "");
  EXPECT_EQ(limit_of(network.state_links[0].state_machine), 1.0);  // what depends on it follows
  EXPECT_EQ(limit_of(network.state_links[1].state_machine), 1.0);
  EXPECT_EQ(limit_of(network.state_links[2].state_machine), 0.6);
  EXPECT_EQ(limit_of(network.sets[0].state_machine), 1.0);
  EXPECT_NO_THROW(engine::Network{network});
}

TEST_F(ParametersOfAScene, OfNamedLinksAreSetForThemAlone) {
  after("strong", "length_m", 0.4);
  after("glue", "length_m", 0.05);

  EXPECT_EQ(limit_of(network.state_links[0].state_machine), 0.2);
  EXPECT_EQ(limit_of(network.state_links[2].state_machine), 0.8);
  EXPECT_EQ(limit_of(network.sets[0].state_machine), 0.1);
}

TEST_F(ParametersOfAScene, KeepWhatWasSetBefore) {
  after("glue", "length_m", 0.05);
  after("brittle", "twice_m", 3.0);
  EXPECT_EQ(limit_of(network.sets[0].state_machine), 3.0);
  after("glue", "length_m", 0.07);
  EXPECT_EQ(limit_of(network.sets[0].state_machine), 3.0);
}

TEST_F(ParametersOfAScene, OfLinearAndMaxwellLinksChangeTheDescription) {
  after("soft", "k", 4.0);
  EXPECT_EQ(network.links[2].stiffness, 8.0);  // after the two of the bar
  EXPECT_EQ(network.links[3].stiffness, 18.0);
  after("stiff", "k", 5.0);
  EXPECT_EQ(network.links[3].stiffness, 10.0);
  EXPECT_EQ(network.links[3].viscosity, 1.0);
  after("late", "viscosity_n_s_per_m", 60.0);
  EXPECT_EQ(network.maxwell_links[0].viscosity, 60.0);
  EXPECT_EQ(network.maxwell_links[0].stiffness, 5.0);
  after("bar.links", "stiffness_n_per_m", 70.0);
  EXPECT_EQ(network.links[0].stiffness, 70.0);
  EXPECT_EQ(network.links[1].stiffness, 70.0);
  EXPECT_EQ(network.links[1].viscosity, 8.0);
  EXPECT_EQ(problem, "");
}

TEST_F(ParametersOfAScene, ThatDoNotExistAreRefused) {
  after("brittel", "length_m", 1.0);
  EXPECT_EQ(problem, "no liaison and no links are named 'brittel'");
  EXPECT_EQ(hint, "did you mean 'brittle'?");
  after("brittle", "lenght_m", 1.0);
  EXPECT_EQ(problem, "'brittle' has no parameter 'lenght_m'");
  EXPECT_EQ(hint, "did you mean 'length_m'?");
  after("bar.links", "k", 1.0);
  EXPECT_EQ(problem, "'bar.links' has no parameter 'k'");
  EXPECT_EQ(hint, "it has stiffness_n_per_m, viscosity_n_s_per_m");
  EXPECT_EQ(limit_of(network.state_links[0].state_machine), 0.2);
}

TEST_F(ParametersOfAScene, OfImpossibleValuesAreRefused) {
  after("late", "stiffness_n_per_m", -1.0);
  EXPECT_EQ(problem, "'stiffness_n_per_m' in liaison 'late' must be > 0, got -1");
  after("soft", "k", std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(problem, "a parameter must be a finite number");
  after("bar.links", "stiffness_n_per_m", -1.0);
  EXPECT_EQ(problem, "'stiffness_n_per_m' must be >= 0");
  EXPECT_EQ(network.maxwell_links[0].stiffness, 5.0);
}

TEST_F(ParametersOfAScene, OfTheWorldAreEachAxisOfGravityAndTheMedium) {
  after("world", "gravity_y_m_per_s2", -1.6);
  EXPECT_EQ(problem, "");
  EXPECT_EQ(network.gravity, engine::Vec3(0.0, -1.6, 0.0));
  after("world", "gravity_x_m_per_s2", 3.0);
  after("world", "viscosity_n_s_per_m", 0.5);
  EXPECT_EQ(network.gravity, engine::Vec3(3.0, -1.6, 0.0));
  EXPECT_EQ(network.medium_viscosity, 0.5);
  const Parameters::Values values = parameters.get("world");
  EXPECT_EQ(values.entries,
            (std::vector<std::pair<std::string, double>>{{"world.gravity_x_m_per_s2", 3.0},
                                                         {"world.gravity_y_m_per_s2", -1.6},
                                                         {"world.viscosity_n_s_per_m", 0.5}}));
  EXPECT_EQ(parameters.names_in_use().back(), "world");

  after("world", "gravity_z_m_per_s2", 1.0);
  EXPECT_EQ(problem, "'world' has no parameter 'gravity_z_m_per_s2'");
  EXPECT_EQ(hint, "it has gravity_x_m_per_s2, gravity_y_m_per_s2, viscosity_n_s_per_m");
  after("world", "viscosity_n_s_per_m", -1.0);
  EXPECT_EQ(problem, "'viscosity_n_s_per_m' must be >= 0");
  after("world", "gravity_x_m_per_s2", 2e6);
  EXPECT_EQ(problem, "'gravity_x_m_per_s2' must be within 1e6");
  after("wrld", "gravity_x_m_per_s2", 1.0);
  EXPECT_EQ(hint, "did you mean 'world'?");
  EXPECT_EQ(network.gravity, engine::Vec3(3.0, -1.6, 0.0));
}

TEST(Parameters, OfAWorldThatFollowsFormulasAreKept) {
  const auto scene = std::make_shared<const Scene>(sound_scene(1,
                                                               R"(
world: {gravity_m_per_s2: sin(time_s), viscosity_n_s_per_m: 1, flow_m_per_s: 2}
matter: {bob: {kind: mass, mass_kg: 1, at_m: 0}}
)"));
  Parameters parameters(scene);
  EXPECT_EQ(parameters.set("world", "gravity_m_per_s2", 1.0).problem,
            "gravity follows a formula in this scene");
  EXPECT_EQ(parameters.set("world", "viscosity_n_s_per_m", 2.0).problem,
            "the medium flows, so its viscosity keeps its value while a run goes on");
  EXPECT_TRUE(parameters.get("world").entries.empty());
}

TEST(Parameters, OfAPortAreFoundBehindADot) {
  const auto scene = std::make_shared<const Scene>(sound_scene(1,
                                                               R"(
matter: {bob: {kind: mass, mass_kg: 1, at_m: 0}}
ports: {key: {device: hand, axes: [0], role: mass, at_m: 0}}
)"));
  Parameters parameters(scene);
  EXPECT_EQ(parameters.get("key").hint, "did you mean 'key.coupling'?");
  EXPECT_EQ(parameters.set("key", "stiffness_n_per_m", 1.0).hint, "did you mean 'key.coupling'?");
}

TEST(Parameters, OfLinksCalledWorldAreThoseOfTheLinks) {
  const auto scene = std::make_shared<const Scene>(sound_scene(1,
                                                               R"(
liaisons: {world: {kind: spring, stiffness_n_per_m: 3}}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 1, at_m: 1}
links: [{liaison: world, between: [wall, bob]}]
)"));
  Parameters parameters(scene);
  EXPECT_EQ(parameters.set("world", "stiffness_n_per_m", 4.0).changes.size(), 1u);
  EXPECT_NE(parameters.set("world", "gravity_m_per_s2", 4.0).problem, "");
  EXPECT_EQ(parameters.names_in_use(), std::vector<std::string>{"world"});
}

TEST(Parameters, OfMatterThatSharesItsStateMachineAreThoseOfTheLiaison) {
  const auto scene = std::make_shared<const Scene>(sound_scene(2,
                                                               R"(liaisons:
  brittle:
    parameters: {length_m: 0.1}
    states:
      whole: {stiffness_n_per_m: 10, exits: [{to: broken, when: elongation_m > length_m}]}
      broken: {}
matter:
  a: {kind: string, count: 3, mass_kg: 1, from_m: [0, 1], to_m: [1, 1], liaison: brittle}
  b: {kind: string, count: 3, mass_kg: 1, from_m: [0, 2], to_m: [1, 2], liaison: brittle}
)"));
  Parameters parameters(scene);

  const Parameters::Outcome outcome = parameters.set("a.links", "length_m", 0.2);

  EXPECT_EQ(outcome.problem, "'a.links' shares its parameters with other links");
  EXPECT_TRUE(outcome.changes.empty());
  EXPECT_EQ(parameters.set("brittle", "length_m", 0.2).changes.size(), 1u);
}

}  // namespace
}  // namespace cordis::scene
