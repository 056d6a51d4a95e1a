// tests/engine/maxwell_test.cpp -- spring and damper in series, with one internal force.
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/engine/links/maxwell_links.h"
#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

const nlohmann::json& rheology() {
  static const nlohmann::json data = reference("R16_rheology");
  return data;
}

double parameter(const char* name) {
  return number(rheology()["params"][name]);
}

/// A port joined to a fixed point by a Maxwell element, by a spring too if `with_spring`.
NetworkDescription element(double step, bool with_spring) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {fixed(Vec3::Zero()), port(Vec3::Zero())};
  scene.maxwell_links = {{0, 1, parameter("K2"), parameter("Z")}};
  if (with_spring) scene.links = {{0, 1, parameter("K1"), 0.0, 0.0}};
  return scene;
}

/// Largest relative error of the force that is left some time after a step of 1 m.
double relaxation_error(double step, bool with_spring) {
  World world = make_world(element(step, with_spring));
  world.impose_position(1, Vec3(1, 0, 0));
  world.step();
  double largest = 0.0;
  for (const auto& row : rheology()["t_values"]) {
    const auto steps = static_cast<std::uint64_t>(std::lround(number(row[0]) / step));
    while (world.step_count() < steps + 1) world.step();
    const double expected = number(row[with_spring ? 3 : 1]);
    largest = std::max(largest, std::abs(world.link_force(0).x() / expected - 1.0));
  }
  return largest;
}

TEST(Maxwell, RelaxesAsItsClosedForm) {
  for (const bool with_spring : {false, true}) {
    const double coarse = relaxation_error(1e-4, with_spring);
    const double fine = relaxation_error(5e-5, with_spring);

    // the step of 1 m takes one period: first order in dt, K dt / 2Z
    EXPECT_LT(coarse, 8e-4);
    EXPECT_NEAR(coarse / fine, 2.0, 0.02);
  }
}

TEST(Maxwell, DecaysByTheExactFactorFromStepToStep) {
  World world = make_world(element(1e-3, false));
  world.impose_position(1, Vec3(1, 0, 0));
  world.step();
  const double first = world.link_force(0).x();
  run(world, 500);

  const double exact = std::exp(-parameter("K2") * 1e-3 / parameter("Z") * 500);
  EXPECT_NEAR(world.link_force(0).x() / first / exact, 1.0, 1e-12);
  EXPECT_EQ(world.tension_of_maxwell(0), world.link_force(0).x()) << "above 0 it pulls";
}

TEST(Maxwell, LosesPerCycleWhatItsLossModulusSays) {
  // standard linear solid, u = sin 10 t; the transient dies with e^(-15 t)
  const double step = 2.0 * M_PI / 10.0 / 20'000.0;
  World world = make_world(element(step, true));
  const auto cycle = [&] {
    for (int n = 0; n < 20'000; ++n) {
      const double t = static_cast<double>(world.step_count() + 1) * step;
      world.impose_position(1, Vec3(std::sin(10.0 * t), 0, 0));
      world.step();
    }
  };
  for (int n = 0; n < 5; ++n) cycle();
  const double work = world.energy().port_work;
  const double dissipated = world.energy().dissipated;
  cycle();

  const double expected = number(rheology()["sls_loss_w10_u1"]);
  EXPECT_NEAR(world.energy().port_work - work, expected, 1e-4 * expected);
  EXPECT_NEAR(world.energy().dissipated - dissipated, expected, 1e-4 * expected);
}

TEST(Maxwell, CreepsInAKelvinVoigtElementOfPlainLinks) {
  // the massless element is met as the mass goes to 0: m / Z = 5e-6 s against a creep of 0.2 s
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-6;
  scene.mats = {fixed(Vec3::Zero()), mass(1e-4, Vec3::Zero())};
  scene.links = {{0, 1, parameter("K1"), parameter("Z"), 0.0}};
  World world = make_world(scene);
  world.set_external_force(1, Vec3(1, 0, 0));

  for (const auto& row : rheology()["t_values"]) {
    if (number(row[0]) > 0.2) break;
    const auto steps = static_cast<std::uint64_t>(std::lround(number(row[0]) / scene.step));
    while (world.step_count() < steps) world.step();
    EXPECT_NEAR(world.position(1).x() / number(row[5]), 1.0, 1e-3);
  }
}

/// A mass that hangs on a Maxwell element, m x'' = m g - F and F' = K x' - F K / Z: F swings about
/// its weight, F = m g + e^(-s t) (A cos w t + B sin w t), s = K / 2Z and w^2 = K / m - s^2.
struct HangingMass {
  double start_speed;
  double start_force;

  static constexpr double kMass = 0.1;
  static constexpr double kStiffness = 300.0;
  static constexpr double kViscosity = 10.0;
  static constexpr double kWeight = 0.98;

  double place(double t) const {
    const double s = 0.5 * kStiffness / kViscosity;
    const double w = std::sqrt(kStiffness / kMass - s * s);
    const double a = start_force - kWeight;
    const double b = (kStiffness * start_speed - 2.0 * s * start_force + s * a) / w;
    const double wave = std::exp(-s * t) * (a * std::cos(w * t) + b * std::sin(w * t));
    const double slope =
        std::exp(-s * t) * w * (b * std::cos(w * t) - a * std::sin(w * t)) - s * wave;
    const double force = kWeight + wave;
    const double speed = slope / kStiffness + force / kViscosity;
    const double impulse = kMass * (start_speed - speed) + kWeight * t;  // of F
    return (force - start_force) / kStiffness + impulse / kViscosity;
  }

  double error(engine::IntegratorKind integrator, double step) const {
    NetworkDescription scene;
    scene.dimension = 1;
    scene.step = step;
    scene.integrator = integrator;
    scene.gravity = Vec3(kWeight / kMass, 0, 0);
    scene.mats = {fixed(Vec3::Zero()), mass(kMass, Vec3::Zero(), Vec3(start_speed, 0, 0))};
    scene.maxwell_links = {{0, 1, kStiffness, kViscosity, start_force}};
    World world = make_world(scene);
    double largest = 0.0;
    while (static_cast<double>(world.step_count()) * step < 0.1 - 0.5 * step) {
      world.step();
      const double t = static_cast<double>(world.step_count()) * step;
      largest = std::max(largest, std::abs(world.position(1).x() - place(t)));
    }
    return largest;
  }
};

TEST(Maxwell, IsOfSecondOrderHoweverItStarts) {
  using engine::IntegratorKind;
  for (const IntegratorKind integrator :
       {IntegratorKind::kCordis, IntegratorKind::kLeapfrog, IntegratorKind::kModal}) {
    for (const HangingMass start : {HangingMass{0.0, 0.0}, HangingMass{1.0, 0.0},
                                    HangingMass{0.0, 5.0}, HangingMass{-1.0, 5.0}}) {
      const double coarse = start.error(integrator, 1e-3);
      const double fine = start.error(integrator, 5e-4);

      EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05)
          << engine::to_string(integrator) << ", speed " << start.start_speed << ", force "
          << start.start_force << ", error " << coarse;
    }
  }
}

TEST(Maxwell, CreepsOnUnderAConstantForce) {
  // u = F (1/K + t/Z), around which a mass swings and comes to rest
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3::Zero())};
  scene.maxwell_links = {{0, 1, 300.0, 2.0}};
  World world = make_world(scene);
  world.set_external_force(1, Vec3(1, 0, 0));
  run(world, 10'000);
  const double before = world.position(1).x();
  run(world, 10'000);

  EXPECT_NEAR((world.position(1).x() - before) / 1.0, 1.0 / 2.0, 1e-5);
}

TEST(Maxwell, KeepsItsAccountInEveryDimension) {
  for (const int dimension : {1, 2, 3}) {
    NetworkDescription scene = free_cluster(20, 61, 0.0, dimension);
    for (const Link& link : scene.links) {
      scene.maxwell_links.push_back({link.mat_a, link.mat_b, link.stiffness, 2.0, 3.0});
    }
    scene.links.clear();
    scene.mats[4].kind = MatKind::kPort;
    scene.mats[4].velocity = Vec3::Zero();
    World world = make_world(scene);
    double largest = 0.0;
    for (int n = 0; n < 10'000; ++n) {
      const Vec3 wave = Vec3(0.1 * std::sin(0.01 * n), 0, 0);
      world.impose_position(4, scene.mats[4].position + wave);
      world.step();
      const engine::Energy energy = world.energy();
      largest = std::max(largest, std::abs(energy.residual()) / energy.largest);
    }
    EXPECT_LT(largest, 1e-11) << "dimension " << dimension;
    EXPECT_GT(world.energy().dissipated, 0.5 * world.energy().initial);
    const double finite_steps = dimension == 1 ? 1e-12 : 1e-3;  // across the line of centres
    EXPECT_LT(std::abs(world.energy().elastic_error), finite_steps * world.energy().largest);
  }
}

/// Two masses that circle each other on a spring, with a Maxwell element beside it, whose length stays as it is.
double orbit_error(engine::IntegratorKind integrator, double step) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.integrator = integrator;
  scene.mats = {mass(0.01, Vec3(-0.1, 0, 0), Vec3(0, -4, 0)),
                mass(0.01, Vec3(0.1, 0, 0), Vec3(0, 4, 0))};
  scene.links = {{0, 1, 80.0, 0.0, 0.18}};  // m v^2 / r = 1.6 N = K (0.2 - 0.18)
  scene.maxwell_links = {{0, 1, 300.0, 10.0}};
  World world = make_world(scene);
  double largest = 0.0;
  while (static_cast<double>(world.step_count()) * step < 2.0) {
    world.step();
    largest = std::max(largest, std::abs((world.position(1) - world.position(0)).norm() - 0.2));
  }
  return largest;
}

TEST(Maxwell, KeepsItsLengthWhileItTurns) {
  using engine::IntegratorKind;
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    const double coarse = orbit_error(integrator, 5e-4);
    const double fine = orbit_error(integrator, 2.5e-4);
    EXPECT_LT(coarse, 1e-4) << engine::to_string(integrator);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1) << engine::to_string(integrator);
  }
}

/// Whatever turns and swings on Maxwell elements alone: their dampers take, and never give.
TEST(Maxwell, NeverGivesEnergyHoweverItTurns) {
  std::mt19937 random(7);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (int run = 0; run < 60; ++run) {
    NetworkDescription scene;
    scene.dimension = 2 + run % 2;
    scene.step = 2.5e-4;
    const std::uint32_t count = 2 + static_cast<std::uint32_t>(random() % 6);
    double energy = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
      Vec3 place(uniform(-0.5, 0.5), uniform(-0.5, 0.5), run % 2 * uniform(-0.5, 0.5));
      Vec3 speed(uniform(-1, 1), uniform(-1, 1), run % 2 * uniform(-1, 1));
      scene.mats.push_back(i == 0 ? fixed(place) : mass(0.001, place, speed));
      if (i > 0) energy += 0.0005 * speed.squaredNorm();
      for (std::uint32_t j = 0; j < i; ++j) {
        const double stiffness = uniform(50.0, 300.0);
        const double length = (place - scene.mats[j].position).norm();
        const double force = run % 3 > 0 ? uniform(0.0, 0.9) * stiffness * length : 0.0;
        scene.maxwell_links.push_back({j, i, stiffness, uniform(0.3, 30.0), force});
        energy += 0.5 * force * force / stiffness;
      }
    }
    World world = make_world(scene);
    for (int n = 0; n < 20'000; ++n) {
      world.step();
      if (n % 50 > 0) continue;
      const engine::Energy now = world.energy();
      ASSERT_GT(now.dissipated, -0.01 * energy) << "run " << run << ", step " << n;
      ASSERT_LT(now.kinetic + now.elastic - now.elastic_error, 1.02 * energy)
          << "run " << run << ", step " << n;
    }
  }
}

TEST(Maxwell, StepsToTheSameBitsOnEveryWidthAndFromASnapshot) {
  for (const int dimension : {1, 2, 3}) {
    NetworkDescription scene = free_cluster(20, 0, 0.0, dimension);
    for (std::uint32_t l = 0; l < 29; ++l) {
      scene.maxwell_links.push_back({l % 20, (l + 7) % 20, 50.0 + l, 0.5, 0.1 * (l % 5)});
    }
    World narrow = make_world(scene, VectorWidth::kSse2);
    const engine::Snapshot start = narrow.snapshot();
    run(narrow, 200);
    const engine::Snapshot snapshot = narrow.snapshot();
    run(narrow, 200);
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(scene, width);
      run(world, 400);
      EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
      EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated);
      world.restore(snapshot);
      run(world, 200);
      EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
      EXPECT_EQ(world.energy().elastic, narrow.energy().elastic);
      world.restore(start);
      run(world, 400);
      EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
    }
  }
}

TEST(ShareOfDecay, IsOneLessTheExponential) {
  for (double x = 1e-18; x < 1e3; x *= 1.37) {
    EXPECT_NEAR(engine::share_of_decay(x) / -std::expm1(-x), 1.0, 2e-15) << x;
  }
  EXPECT_EQ(engine::share_of_decay(0.0), 0.0);
}

}  // namespace
}  // namespace cordis::test
