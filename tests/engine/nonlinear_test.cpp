// tests/engine/nonlinear_test.cpp -- laws that are not linear: closed forms, and chains of them.
#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using engine::Law;

LinkState with(const Law& elasticity, double stiffness = 0.0) {
  LinkState state;
  state.stiffness = stiffness;
  state.elasticity = elasticity;
  return state;
}

/// Tension of a link of one state at some distances, rest length 0.5, nothing moving.
std::vector<double> tensions(const LinkState& state, const std::vector<double>& distances,
                             VectorWidth width) {
  NetworkDescription scene;
  scene.step = 0.01;
  scene.mats.push_back(fixed(Vec3::Zero()));
  scene.state_machines = {Behaving().state(state).state_machine};
  for (const double distance : distances) {
    scene.state_links.push_back({0, static_cast<std::uint32_t>(scene.mats.size()), 0, 0.5});
    scene.mats.push_back(fixed(Vec3(0, distance, 0)));
  }
  World world = make_world(scene, width);
  world.step();
  std::vector<double> found;
  for (std::uint32_t l = 0; l < distances.size(); ++l) {
    found.push_back(world.tension_of(l));
    EXPECT_NEAR(world.link_force(l + 1).y(), -found.back(), 1e-12 * std::abs(found.back()));
  }
  return found;
}

class Laws : public testing::TestWithParam<VectorWidth> {
 protected:
  static void expect_tensions(const LinkState& state, double (*expected)(double distance)) {
    std::vector<double> distances;
    for (int i = 1; i <= 61; ++i) distances.push_back(0.05 * i - 0.0123);
    const std::vector<double> found = tensions(state, distances, GetParam());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double tension = expected(distances[i]);
      EXPECT_NEAR(found[i], tension, 1e-13 * (1.0 + std::abs(tension))) << "at " << distances[i];
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Widths, Laws, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST_P(Laws, OfATableIsLinearBetweenItsPointsAndConstantBeyond) {
  expect_tensions(with(table_law()), [](double d) {
    const double e = d - 0.5;
    if (e < -0.2) return -9.0;
    if (e < -0.05) return -9.0 + 8.0 * (e + 0.2) / 0.15;
    if (e < 0.0) return -1.0 + (e + 0.05) / 0.05;
    if (e < 0.1) return 25.0 * e;
    return std::min(3.0, 2.5 + 0.5 * (e - 0.1) / 0.2);
  });
}

TEST_P(Laws, OfATableMeetsItsPointsExactly) {
  LinkState state;
  state.elasticity = engine::Table{{-0.25, 0.125, 0.25, 1.5}, {-0.3, 0.7, 0.1, 7.7}};
  EXPECT_EQ(tensions(state, {0.25, 0.625, 0.75, 2.0, 0.125, 9.0}, GetParam()),
            (std::vector<double>{-0.3, 0.7, 0.1, 7.7, -0.3, 7.7}));
  state.elasticity = engine::Table{{0.3}, {2.5}};
  EXPECT_EQ(tensions(state, {0.25, 0.75, 0.8}, GetParam()), (std::vector<double>{2.5, 2.5, 2.5}));
}

TEST_P(Laws, OfALongTableFindsEverySegment) {
  std::vector<double> arguments;
  std::vector<double> value;
  for (int i = 0; i < 77; ++i) {
    arguments.push_back(0.03 * i - 0.4);
    value.push_back(i * i);
  }
  const LinkState state = with(engine::Table(arguments, value));
  std::vector<double> distances;
  for (int i = 0; i < 76; ++i) distances.push_back(0.5 + 0.03 * (i + 0.5) - 0.4);
  const std::vector<double> found = tensions(state, distances, GetParam());
  for (int i = 0; i < 76; ++i) EXPECT_NEAR(found[i], i * i + i + 0.5, 1e-9);
}

TEST_P(Laws, OfAPowerKeepsTheSignOfTheElongation) {
  expect_tensions(with(power_law(3.0, 1.5)), [](double d) {
    return std::copysign(3.0 * std::pow(std::abs(d - 0.5), 1.5), d - 0.5);
  });
  expect_tensions(with(power_law(-2.0, 7.0)),
                  [](double d) { return -2.0 * std::pow(d - 0.5, 7.0); });
  expect_tensions(with(power_law(2.0, 0.5)), [](double d) {
    return std::copysign(2.0 * std::sqrt(std::abs(d - 0.5)), d - 0.5);
  });
  expect_tensions(with(power_law(4.0, 0.0)), [](double d) { return d < 0.5 ? -4.0 : 4.0; });
  EXPECT_EQ(tensions(with(power_law(4.0, 0.0)), {0.5}, GetParam()), std::vector<double>{0.0});
}

TEST_P(Laws, OfLennardJonesIsTheSlopeOfItsPotential) {
  expect_tensions(with(lennard_jones_law(2e-3, 0.6, 0.0)), [](double d) {
    const double r = 0.6 / d;
    return 4.0 * 2e-3 * (-12.0 * std::pow(r, 12) + 6.0 * std::pow(r, 6)) / d;
  });
  expect_tensions(with(lennard_jones_law(2e-3, 0.6, 1.5)), [](double d) {
    const double r = 0.6 / d;
    return d < 1.5 ? 4.0 * 2e-3 * (-12.0 * std::pow(r, 12) + 6.0 * std::pow(r, 6)) / d : 0.0;
  });
}

TEST_P(Laws, OfRingsAddUp) {
  expect_tensions(with(ring_law()), [](double d) {
    double tension = 0.0;
    if (d < 0.2) tension -= 40.0 * (0.2 - d);
    if (d < 0.4) tension += 15.0 * (0.4 - d);
    return tension;
  });
}

/// if(e < 0.4, tanh(3 e) exp(-|e|) + sin(9 d) cos(d) + log(d + 2) + d^1.7 - d^3, sign(-d)).
Law law_of_every_function() {
  const Term d = q(Quantity::kDistance);
  const Term e = q(Quantity::kElongation);
  Term cube = one(Operation::kWholePower, d);
  cube.program.code.back().constant = 3.0;
  const Term decay = one(Operation::kExp, one(Operation::kNegate, size(e)));
  const Term sum = one(Operation::kTanh, 3.0 * e) * decay +
                   one(Operation::kSin, 9.0 * d) * one(Operation::kCos, d) +
                   one(Operation::kLog, d + 2.0) + two(Operation::kPower, d, 1.7) - cube;
  return expression_law(
      three(Operation::kSelect, e < 0.4, sum, one(Operation::kSign, one(Operation::kNegate, d))));
}

TEST_P(Laws, OfAnExpressionHaveTheBitsOfTheScalarEvaluator) {
  const LinkState state = with(law_of_every_function());
  std::vector<double> distances;
  for (int i = 1; i < 60; ++i) distances.push_back(0.02 * i);
  const std::vector<double> found = tensions(state, distances, GetParam());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double d = distances[i];
    EXPECT_EQ(found[i], elastic_tension(state.elasticity, {d, d - 0.5, 0.0, 1.0, 1.0}));
  }
  expect_tensions(state, [](double d) {
    const double e = d - 0.5;
    if (e >= 0.4) return -1.0;
    return std::tanh(3.0 * e) * std::exp(-std::abs(e)) + std::sin(9.0 * d) * std::cos(d) +
           std::log(d + 2.0) + std::pow(d, 1.7) - d * d * d;
  });
}

TEST_P(Laws, OfAnExpressionWithoutAFiniteValueAreTensionsOfZero) {
  const Term below = q(Quantity::kDistance) - 1.0;
  EXPECT_EQ(tensions(with(expression_law(one(Operation::kSqrt, below))), {0.75, 5.0}, GetParam()),
            (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(tensions(with(expression_law(1.0 / below)), {1.0, 1.5}, GetParam()),
            (std::vector<double>{0.0, 2.0}));
}

TEST_P(Laws, OfAnExpressionComeOnTopOfTheSpring) {
  expect_tensions(with(cubic_law(), 7.0), [](double d) {
    const double e = d - 0.5;
    return 7.0 * e + 30.0 * e + 100.0 * e * e * e;
  });
}

TEST_P(Laws, OfViscosityAnswerToTheSpeed) {
  const auto tension = [](const Law& dissipation, double speed) {
    NetworkDescription scene;
    scene.dimension = 1;
    scene.step = 0.01;
    scene.mats = {fixed(Vec3::Zero()), port(Vec3(1, 0, 0))};
    LinkState state;
    state.dissipation = dissipation;
    scene.state_machines = {Behaving().state(state).state_machine};
    scene.state_links = {{0, 1, 0, 0.3}};
    World world = make_world(scene, GetParam());
    world.impose_position(1, Vec3(1.0 + 0.01 * speed, 0, 0));
    world.step();
    return world.tension_of(0);
  };
  EXPECT_NEAR(tension(table_law(), 0.05), 1.25, 1e-9);
  EXPECT_NEAR(tension(table_law(), -7.0), -9.0, 1e-9);
  EXPECT_NEAR(tension(power_law(3.0, 2.0), -0.5), -0.75, 1e-9);
  EXPECT_NEAR(tension(power_law(3.0, 0.0), -0.5), -3.0, 1e-9);
}

/// A chain between fixed ends in 1 dimension: masses at `q`, of the half-step speed that makes
/// them start with the momenta `p`.
NetworkDescription chain(const std::vector<double>& q, const std::vector<double>& p, double step,
                         std::vector<StateMachine> state_machines) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::size_t i = 0; i < q.size(); ++i) {
    scene.mats.push_back(mass(1.0, Vec3(q[i], 0, 0), Vec3(p[i], 0, 0)));
  }
  scene.mats.push_back(fixed(Vec3::Zero()));
  const auto kinds = static_cast<std::uint32_t>(state_machines.size());
  for (std::uint32_t l = 0; l <= q.size(); ++l) {
    scene.state_links.push_back({l, l + 1, l % kinds, 0.0});
  }
  scene.state_machines = std::move(state_machines);
  return scene;
}

double duffing_error(double step) {
  const nlohmann::json data = reference("R07_duffing");
  NetworkDescription scene = chain(
      {number(data["params"]["x0"])}, {0.0}, step,
      {Behaving().state(with(power_law(number(data["params"]["k3"]), 3.0), 1.0)).state_machine});
  scene.state_links.pop_back();
  World world = make_world(scene);
  double largest = 0.0;
  for (const auto& row : data["t_x"]) {
    const auto steps = static_cast<std::uint64_t>(std::lround(number(row[0]) / step));
    while (world.step_count() < steps) world.step();
    largest = std::max(largest, std::abs(world.position(1).x() - number(row[1])));
  }
  return largest;
}

TEST(Duffing, IsMetToSecondOrder) {
  const double coarse = duffing_error(2e-3);
  const double fine = duffing_error(1e-3);

  EXPECT_LT(fine, 2e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

double stiff_chain_error(double step) {
  const nlohmann::json data = reference("R09_stiff_fpu_hairer");
  std::vector<double> start;
  std::vector<double> momentum;
  for (const auto& value : data["initial_q"]) start.push_back(number(value));
  for (const auto& value : data["initial_p"]) momentum.push_back(number(value));
  const double omega = number(data["params"]["omega"]);
  World world = make_world(chain(start, momentum, step,
                                 {Behaving().state(with(power_law(4.0, 3.0))).state_machine,
                                  Behaving().state(0.5 * omega * omega).state_machine}));
  const auto& row = data["rows"][0];
  const auto steps = static_cast<int>(std::lround(row["t"].get<double>() / step));
  run(world, steps);
  double largest = 0.0;
  for (std::uint32_t i = 0; i < 6; ++i) {
    largest = std::max(largest, std::abs(world.position(i + 1).x() - number(row["q"][i])));
  }
  return largest;
}

TEST(StiffChain, OfHairerLubichWannerIsMetToSecondOrder) {
  const double coarse = stiff_chain_error(2e-4);
  const double fine = stiff_chain_error(1e-4);

  EXPECT_LT(fine, 1e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

/// Energy of a mode of a chain of 32 masses, positions and speeds at the same time.
double mode_energy(const std::vector<double>& x, const std::vector<double>& v, int mode) {
  double amplitude = 0.0;
  double speed = 0.0;
  for (int i = 1; i <= 32; ++i) {
    const double shape = std::sqrt(2.0 / 33.0) * std::sin(std::numbers::pi * mode * i / 33.0);
    amplitude += shape * x[i - 1];
    speed += shape * v[i - 1];
  }
  const double w = 2.0 * std::sin(std::numbers::pi * mode / 66.0);
  return 0.5 * (speed * speed + w * w * amplitude * amplitude);
}

TEST(FermiPastaUlam, SharesTheEnergyOfItsModesAsTheReference) {
  const nlohmann::json data = reference("R10_fpu_alpha");
  const Term elongation = q(Quantity::kElongation);
  const Law law = expression_law(number(data["params"]["alpha"]) * elongation * elongation);
  std::vector<double> start;
  for (int i = 1; i <= 32; ++i) start.push_back(std::sin(std::numbers::pi * i / 33.0));
  const double step = 0.01;
  World world = make_world(chain(start, std::vector<double>(32, 0.0), step,
                                 {Behaving().state(with(law, 1.0)).state_machine}));
  run(world, 99'999);
  std::vector<double> before;
  for (std::uint32_t i = 1; i <= 32; ++i) before.push_back(world.position(i).x());
  world.step();
  std::vector<double> now;
  for (std::uint32_t i = 1; i <= 32; ++i) now.push_back(world.position(i).x());
  world.step();
  std::vector<double> speed;
  for (std::uint32_t i = 1; i <= 32; ++i) {
    speed.push_back((world.position(i).x() - before[i - 1]) / (2.0 * step));
  }

  for (int mode = 1; mode <= 5; ++mode) {
    const double expected = data["mode_energies_1to5"]["t=1000"][mode - 1].get<double>();
    EXPECT_NEAR(mode_energy(now, speed, mode), expected, 2e-6) << "mode " << mode;
  }
}

TEST(ExpressionLaw, IsEvaluatedByManyThreadsAtOnce) {
  const auto network = std::make_shared<const engine::Network>(
      chain({0.1, -0.2, 0.3, 0.05}, std::vector<double>(4, 0.0), 0.01,
            {Behaving().state(with(law_of_every_function(), 1.0)).state_machine}));
  const auto hash_after_run = [&network] {
    World world(network);
    for (int n = 0; n < 20'000; ++n) world.step();
    return world.state_hash();
  };
  const std::uint64_t alone = hash_after_run();
  std::vector<std::future<std::uint64_t>> together;
  for (int i = 0; i < 3; ++i) together.push_back(std::async(std::launch::async, hash_after_run));
  for (std::future<std::uint64_t>& each : together) EXPECT_EQ(each.get(), alone);
}

}  // namespace
}  // namespace cordis::test
