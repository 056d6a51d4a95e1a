// tests/plan/integrator_limit_test.cpp -- what the plan says of every integrator is what it does.
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/oscillator_error.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

class EveryIntegrator : public testing::TestWithParam<IntegratorKind> {};

/// What the integrator takes: the scene, or the scene without what it refuses.
NetworkDescription for_integrator(NetworkDescription scene, IntegratorKind integrator) {
  scene.integrator = integrator;
  const bool modal = integrator == IntegratorKind::kModal;
  if (integrator == IntegratorKind::kSymplectic4 || (modal && scene.links.size() > 1)) {
    scene.medium_viscosity = 0.0;
    for (Link& link : scene.links) link.viscosity = 0.0;
  }
  return scene;
}

TEST_P(EveryIntegrator, DivergesOnRandomNetworksWhereThePlanSays) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    NetworkDescription scene = for_integrator(random_network(seed), GetParam());
    scene.step = 1e-7;
    const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
    EXPECT_LE(stability.certified.step, stability.diverging_step * (1.0 + 1e-6)) << seed;
    if (!std::isfinite(stability.diverging_step)) continue;

    // of symplectic4, between its two limits there may be a resonance
    const bool resonates = GetParam() == IntegratorKind::kSymplectic4;
    const double stable = resonates ? engine::kSymplectic4Limit / 5.0269 : 1.0;
    scene.step = 0.99 * stable * stability.diverging_step;
    // between the two limits of implicit dampers their modes decide
    if (engine::damps_implicitly(scene)) scene.step = 0.99 * stability.certified.step;
    EXPECT_LT(largest_excursion(scene, 3000), 1e3) << seed;
    scene.step = 1.01 * stability.diverging_step;
    EXPECT_GT(largest_excursion(scene, 20000), 1e6) << seed;
  }
}

// m = 1 and dt = 1. Without the friction one mass is stable up to K' = 4 at Z' = 0, up to 5.4 at 5.
TEST(IntegratorLimit, OfFrictionSolvedBesideDampersIsNotCertain) {
  struct Case {
    double stiffness;
    double viscosity;
    bool diverges;
  };
  for (const Case& one : {Case{3.0, 0.0, false}, Case{25.0, 0.0, true}, Case{6.0, 5.0, false}}) {
    NetworkDescription scene = oscillator(1.0, one.stiffness, one.viscosity, 1.0, 0.0, 1.0);
    scene.integrator = IntegratorKind::kLeapfrog;
    scene.mats.push_back(mass(1.0, Vec3(2.0, 0, 0)));  // has a heavy damper in both cases
    scene.links.push_back({0, 2, 0.0, 1.0, 0.0});
    scene.state_machines.push_back(state_machine(0.0));
    scene.state_machines[0].states[0].viscosity = 10.0;
    scene.state_links = {{0, 1, 0, 0.0}};
    const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
    EXPECT_TRUE(stability.uncertainty.has_value()) << one.stiffness;
    EXPECT_FALSE(stability.diverges()) << one.stiffness;
    EXPECT_EQ(largest_excursion(scene, 4000) > 1e3, one.diverges) << one.stiffness;
  }
}

/// All that meet at a mass are solved where one of them is heavy: it is named, wherever it stands in the file.
TEST(IntegratorLimit, OfFrictionBesideDampersNamesTheHeaviestThatIsSolved) {
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 1.0, 0.0, 1.0);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.mats.push_back(mass(1.0, Vec3(2.0, 0, 0)));
  scene.links.push_back({0, 2, 0.0, 1.0, 0.0});
  scene.state_machines.assign(3, state_machine(0.0));
  scene.state_machines[0].states[0].viscosity = 0.01;
  scene.state_machines[1].states[0].viscosity = 10.0;
  scene.state_machines[2].states[0].dissipation =
      engine::Power{0.1, 0.0};  // dry: solved at every step
  const auto named = [&scene](const std::vector<std::uint32_t>& laws) {
    scene.state_links.clear();
    for (const std::uint32_t law : laws) scene.state_links.push_back({0, 1, law, 0.0});
    const auto uncertainty = plan::uncertainty_of(scene, plan::liaison_graph(scene));
    return uncertainty ? laws.at(uncertainty->liaison.index) : 99;
  };
  EXPECT_EQ(named({0, 1}), 1u);
  EXPECT_EQ(named({1, 0}), 1u);
  EXPECT_EQ(named({0, 1, 2}), 2u);
  EXPECT_EQ(named({2, 1, 0}), 2u);
  EXPECT_EQ(named({0}), 99u) << "a light one is not solved";
}

TEST(IntegratorLimit, OfModesIsWhatIsFastenedToThem) {
  NetworkDescription scene = string_in_space(20, 0.01, 4e-4);
  scene.dimension = 1;
  scene.integrator = IntegratorKind::kModal;
  for (Mat& mat : scene.mats) mat.position = Vec3(mat.position.y(), 0, 0);
  scene.state_machines.push_back(state_machine(1000.0));
  scene.state_links = {{0, 7, 0, 0.0}};
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  const double load = std::pow(scene.step / stability.diverging_step, 2.0);
  EXPECT_NEAR(stability.certified.step, stability.diverging_step, 1e-9 * scene.step);

  scene.state_machines[0].states[0].stiffness = 0.98 * 1000.0 / load;
  EXPECT_TRUE(plan::stability_of(scene, plan::liaison_graph(scene)).holds());
  EXPECT_LT(largest_excursion(scene, 20000), 1e3);
  scene.state_machines[0].states[0].stiffness = 1.02 * 1000.0 / load;
  EXPECT_TRUE(plan::stability_of(scene, plan::liaison_graph(scene)).diverges());
  EXPECT_GT(largest_excursion(scene, 20000), 1e6);
}

/// However stiff an element is, it adds no more than 2 Z / dt.
TEST(IntegratorLimit, OfAMaxwellElementBesideModesCountsItsViscosity) {
  for (const double ratio : {0.1, 1.0, 10.0, 300.0}) {  // K dt / Z
    NetworkDescription scene = string_in_space(20, 0.01, 4e-4);
    scene.dimension = 1;
    scene.integrator = IntegratorKind::kModal;
    for (Mat& mat : scene.mats) mat.position = Vec3(mat.position.y(), 0, 0);
    scene.maxwell_links = {{0, 7, ratio, scene.step, 0.0}};
    const plan::Stability small = plan::stability_of(scene, plan::liaison_graph(scene));
    const double load = std::pow(scene.step / small.diverging_step, 2.0);
    const auto scale_to = [&](double share) {
      scene.maxwell_links[0].stiffness = share * ratio / load;
      scene.maxwell_links[0].viscosity = share * scene.step / load;
      return plan::stability_of(scene, plan::liaison_graph(scene));
    };
    EXPECT_TRUE(scale_to(0.98).holds()) << ratio;
    EXPECT_LT(largest_excursion(scene, 20000), 1e3) << ratio;
    EXPECT_TRUE(scale_to(1.02).diverges()) << ratio;
    EXPECT_GT(largest_excursion(scene, 20000), 1e6) << ratio;
  }
}

TEST(IntegratorLimit, OfASetBesideModesIsNotKnownAndNamesTheSet) {
  NetworkDescription scene = oscillator(0.05, 500.0, 0.0, 0.0, 1.0, 1e-4);
  scene.integrator = IntegratorKind::kModal;
  scene.state_machines.push_back(state_machine(1.0));
  scene.state_links = {{0, 1, 0, 0.0}};
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1};
  set.range = set.rest_length = 0.001;
  scene.sets.push_back(set);
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  ASSERT_TRUE(stability.uncertainty.has_value());
  EXPECT_EQ(stability.uncertainty->liaison.kind, plan::LiaisonKind::kSet);
  ASSERT_TRUE(stability.certified.liaison.has_value());
  EXPECT_EQ(stability.certified.liaison->kind, plan::LiaisonKind::kSet);
  EXPECT_FALSE(stability.diverges());
}

TEST(IntegratorLimit, OfLeapfrogOnLinksItSolvesIsTheirStiffness) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, 0.0, 1e-6);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.links.clear();
  scene.state_machines = {state_machine(100.0)};
  scene.state_machines[0].states[0].viscosity = 8.0;  // extrapolated up to 38 ms
  scene.state_links = {{0, 1, 0, 0.0}};
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  EXPECT_NEAR(stability.certified.step, 0.2, 1e-9);
  EXPECT_NEAR(stability.diverging_step, 0.2, 1e-6);

  scene.step = 0.99 * 0.2;
  EXPECT_LT(largest_excursion(scene, 3000), 10.0);
  scene.step = 1.01 * 0.2;
  EXPECT_GT(largest_excursion(scene, 20000), 1e6);
}

/// K' = 2 Z' at 4 s.
TEST(IntegratorLimit, OfLeapfrogOnHeavyLinksItSolvesIsBeyondTheirStiffness) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, 0.0, 1e-6);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.links.clear();
  scene.state_machines = {state_machine(100.0)};
  scene.state_machines[0].states[0].viscosity = 200.0;
  scene.state_links = {{0, 1, 0, 0.0}};
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  EXPECT_NEAR(stability.certified.step, 0.2, 1e-9);
  EXPECT_TRUE(std::isinf(stability.diverging_step));

  scene.step = 3.9;
  EXPECT_LT(largest_excursion(scene, 3000), 100.0);
  scene.step = 4.1;
  EXPECT_GT(largest_excursion(scene, 20000), 1e6);
  scene.integrator = IntegratorKind::kCordis;
  scene.step = 1e-6;
  EXPECT_LT(plan::stability_of(scene, plan::liaison_graph(scene)).certified.step, 0.0101);
}

TEST_P(EveryIntegrator, SwingsAndDecaysAsThePlanSays) {
  // 5 Hz at 100 steps a second, and so viscous that `leapfrog` damps implicitly
  const double w = 10.0 * M_PI;
  for (const double viscosity : {0.0, 0.8, 35.0}) {
    NetworkDescription scene =
        for_integrator(oscillator(1.0, w * w, viscosity, 1.0, 0.0, 0.01), GetParam());
    const double seen = scene.links[0].viscosity;  // 0 where viscosity is refused
    World world = make_world(scene);
    // x(n+2) = trace x(n+1) - product x(n), once the start is forgotten
    run(world, 4);
    const double a = world.position(1).x();
    run(world, 1);
    const double b = world.position(1).x();
    run(world, 1);
    const double c = world.position(1).x();
    run(world, 1);
    const double d = world.position(1).x();
    const double product = (b * d - c * c) / (a * c - b * b);
    const double trace = (a * d - b * c) / (a * c - b * b);
    const double frequency = std::sqrt(w * w - 0.25 * seen * seen);
    const double pitch =
        std::atan2(std::sqrt(product - 0.25 * trace * trace), 0.5 * trace) / (0.01 * frequency);

    const auto error = plan::oscillator_error(w, seen, 0.01, GetParam());

    ASSERT_TRUE(error.oscillates);
    EXPECT_NEAR(pitch - 1.0, error.pitch, 1e-4) << viscosity;
    const double decay = -0.5 * std::log(product) / 0.01;
    EXPECT_NEAR(seen > 0.0 ? decay / (0.5 * seen) - 1.0 : decay / w, error.decay, 1e-4)
        << viscosity;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, EveryIntegrator, testing::ValuesIn(engine::kIntegrators),
                         [](const auto& integrator) { return to_string(integrator.param); });

}  // namespace
}  // namespace cordis::test
