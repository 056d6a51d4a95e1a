// tests/engine/drive_test.cpp -- MATs that follow a function of time.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/block_on_a_belt.h"
#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using engine::Drive;
using engine::Energy;
using engine::IntegratorKind;
using engine::StepReport;
using engine::TimeFunction;

constexpr double kPi = 3.14159265358979323846;

Term now() {
  return q(Quantity::kAge);
}
Term sine(Term angle) {
  return one(Operation::kSin, std::move(angle));
}

TimeFunction along_x(Term formula) {
  TimeFunction function;
  function.formula[0] = std::move(formula.program);
  return function;
}

TimeFunction table(std::vector<double> time, const std::vector<double>& x, bool smooth) {
  TimeFunction function;
  function.time = std::move(time);
  for (const double value : x) function.value.emplace_back(value, 0.0, 0.0);
  function.smooth = smooth;
  return function;
}

void push(NetworkDescription& scene, std::uint32_t mat, TimeFunction function) {
  Drive drive;
  drive.mat = mat;
  drive.function = static_cast<std::uint32_t>(scene.time_functions.size());
  drive.is_force = true;
  scene.time_functions.push_back(std::move(function));
  scene.drives.push_back(drive);
}

/// The part of the vibration of a mass at a frequency, by its Fourier integral over whole periods.
std::complex<double> response_at(World& world, std::uint32_t mat, double frequency, int from_period,
                                 int periods) {
  const double step = world.network().step();
  const auto steps = static_cast<int>(std::lround(1.0 / (frequency * step)));
  run(world, from_period * steps);
  std::complex<double> sum = 0.0;
  for (int n = 0; n < periods * steps; ++n) {
    const double angle = 2.0 * kPi * static_cast<double>(world.step_count()) / steps;
    sum += world.position(mat).x() * std::polar(1.0, -angle);
    world.step();
  }
  return 2.0 * sum / static_cast<double>(periods * steps);
}

/// A mass on a spring-damper whose other end is shaken with 1 mm: relative error of its response.
double error_of_base_excitation(IntegratorKind integrator, double frequency, int steps_of_period) {
  const double mass_kg = 0.2;
  const double stiffness = 80.0;  // 3.18 Hz
  const double viscosity = 1.2;
  NetworkDescription scene = oscillator(mass_kg, stiffness, viscosity, 0.0, 0.0, 1e-3);
  scene.step = 1.0 / (frequency * steps_of_period);
  scene.integrator = integrator;
  const double w = 2.0 * kPi * frequency;
  drive_mat(scene, 0, along_x(Term(1e-3) * sine(Term(w) * now())));
  World world = make_world(scene);

  const auto settled = static_cast<int>(std::ceil(10.0 * frequency));  // e^-30 is left
  const std::complex<double> response = response_at(world, 1, frequency, settled, 10);

  const std::complex<double> across(stiffness, viscosity * w);
  const std::complex<double> exact =
      1e-3 * std::complex<double>(0.0, -1.0) * across / (across - mass_kg * w * w);
  return std::abs(response - exact) / std::abs(exact);
}

TEST(Drive, ShakesAnOscillatorWithItsExactAmplitudeAndPhase) {
  for (const double frequency : {0.5, 2.0, 3.2, 5.0, 12.0}) {
    // the damper of `cordis` looks half a period back, that of `leapfrog` does not
    EXPECT_LT(error_of_base_excitation(IntegratorKind::kCordis, frequency, 2000), 5e-3);
    EXPECT_LT(error_of_base_excitation(IntegratorKind::kLeapfrog, frequency, 2000), 3e-5);
    EXPECT_LT(error_of_base_excitation(IntegratorKind::kImplicit, frequency, 2000), 2e-2);
  }
}

/// What a driven end brings in by a damper is what the mass gains and the damper takes.
TEST(Drive, DragsAMassThroughADamperWithoutAnIntegrationError) {
  for (const auto integrator : {IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
    for (const double viscosity : {0.02, 0.1, 0.5}) {  // Z'
      NetworkDescription scene = oscillator(1e-3, 0.0, viscosity, 0.0, 0.0, 1e-3);
      scene.integrator = integrator;
      drive_mat(scene, 0, along_x(Term(0.01) * sine(Term(6.0 * kPi) * now())));
      World world = make_world(scene);
      run(world, 970);
      const engine::Energy energy = world.energy();
      EXPECT_LT(std::abs(energy.integration_error()), 0.02 * energy.largest)
          << to_string(integrator) << " Z' " << viscosity;
    }
  }
}

TEST(Drive, HasTheOrderOfItsIntegrator) {
  const auto fall = [](IntegratorKind integrator) {
    return error_of_base_excitation(integrator, 3.2, 500) /
           error_of_base_excitation(integrator, 3.2, 1000);
  };
  EXPECT_NEAR(fall(IntegratorKind::kCordis), 2.0, 0.2);
  EXPECT_NEAR(fall(IntegratorKind::kLeapfrog), 4.0, 0.4);
}

TEST(Drive, PushesAFreeMassAsNewtonSays) {
  // m x" = F cos(w t) from rest: x = F / (m w^2) (1 - cos(w t))
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-4;
  scene.mats = {mass(0.5, Vec3::Zero())};
  const double w = 40.0;
  push(scene, 0, along_x(Term(3.0) * one(Operation::kCos, Term(w) * now())));
  World world = make_world(scene);

  for (int n = 1; n <= 5000; ++n) {
    world.step();
    const double exact = 3.0 / (0.5 * w * w) * (1.0 - std::cos(w * n * scene.step));
    ASSERT_NEAR(world.position(0).x(), exact, 4e-6 * 3.0 / (0.5 * w * w)) << n;  // (w dt)^2 / 12
  }
  EXPECT_LT(std::abs(world.energy().residual()), 1e-12 * world.energy().largest);
}

TEST(Drive, BringsNothingBeforeTheStart) {
  for (const auto integrator : {IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
    // a mass that moves is pushed with 3 N, and a piston with 1 m/s goes on
    NetworkDescription scene = oscillator(0.2, 50.0, 0.0, 0.1, 1.0, 1e-3);
    scene.integrator = integrator;
    scene.time_functions = {table({0.0, 1.0}, {3.0, 3.0}, false),
                            table({0.0, 1.0}, {0.0, 1.0}, false)};
    scene.drives = {{1, 0, true, Vec3::Zero()}};
    scene.mats.push_back(port(Vec3(-0.5, 0, 0)));
    scene.drives.push_back({2, 1, false, scene.mats[2].position});
    scene.links.push_back({2, 1, 20.0, 0.0, 0.0});
    World world = make_world(scene);
    const Vec3 start = world.position(1);
    world.step();
    EXPECT_EQ(world.energy().port_work, 0.0);
    const Vec3 next = world.position(1);
    world.step();
    const double tension = 20.0 * (0.5 + 0.5 * (start.x() + next.x()) - 0.0005);
    const double work = 3.0 * (next - start).x() - tension * 1e-3;
    EXPECT_NEAR(world.energy().port_work, work, 1e-12);
  }
}

TEST(Drive, OfAPistonBringsWhatTheSpringStores) {
  for (const bool smooth : {false, true}) {
    NetworkDescription scene = oscillator(0.1, 500.0, 0.0, 0.0, 0.0, 1e-3);
    scene.mats = {fixed(Vec3::Zero()), fixed(Vec3(0.3, 0, 0)), mass(1.0, Vec3(5, 0, 0))};
    scene.links = {{0, 1, 500.0, 0.0, 0.3}};
    drive_mat(scene, 1, table({0.1, 0.4}, {0.0, -0.1}, smooth));
    World world = make_world(scene);

    run(world, 600);

    EXPECT_DOUBLE_EQ(world.position(1).x(), 0.2);
    EXPECT_NEAR(world.energy().port_work, 0.5 * 500.0 * 0.01, 1e-12);
    EXPECT_NEAR(world.energy().elastic, 0.5 * 500.0 * 0.01, 1e-12);
  }
}

TEST(Drive, IsTheBeltOfAStickingAndSlippingBlock) {
  const nlohmann::json data = reference("R15_stick_slip_coulomb");
  const nlohmann::json& params = data["params"];
  const double step = 1e-5;
  NetworkDescription scene = block_on_a_belt(params, step);
  drive_mat(scene, 2, along_x(Term(number(params["V"])) * now()));
  World world = make_world(scene);

  std::vector<double> slips;
  std::vector<double> work;
  double furthest = 0.0;
  while (slips.size() < 4 && world.step_count() < 600'000) {
    world.step();
    furthest = std::max(furthest, world.position(1).x());
    if (world.events().empty() || world.state_of(0) != 1) continue;
    slips.push_back(static_cast<double>(world.step_count()) * step);
    work.push_back(world.energy().port_work);
  }

  ASSERT_EQ(slips.size(), 4u);
  const double period = number(data["period"]);
  EXPECT_NEAR(slips[3] - slips[2], period, 1e-4 * period);
  EXPECT_NEAR(furthest, number(data["x_max"]), 1e-3 * furthest);
  const double of_belt = number(data["dissipated_per_period_equals_belt_work"]);
  EXPECT_NEAR(work[3] - work[2], of_belt, 1e-3 * of_belt);
  EXPECT_LT(std::abs(world.energy().residual()), 1e-9 * world.energy().largest);
}

TEST(Drive, StandsAtItsFunctionAfterEveryStep) {
  NetworkDescription scene = oscillator(0.1, 50.0, 0.2, 0.02, 0.0, 1e-3);
  drive_mat(scene, 0, along_x(Term(0.01) * sine(Term(30.0) * now())));
  const TimeFunction function = scene.time_functions[0];
  World world = make_world(scene);

  for (std::uint64_t n = 0; n < 500; ++n) {
    const double time = static_cast<double>(n) * scene.step;
    ASSERT_EQ(world.position(0).x(), value_at(function, time).x());
    if (n > 0) {
      const double before = value_at(function, static_cast<double>(n - 1) * scene.step).x();
      ASSERT_EQ(world.velocity(0).x(), (world.position(0).x() - before) / scene.step);
    }
    world.step();
  }
}

TEST(Drive, BeginsWithTheVelocityOfItsFirstPeriod) {
  // a damper from a steady MAT to a fixed point has its whole force from the first step on
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.mats.push_back(fixed(Vec3::Zero()));
  scene.links = {{0, 2, 0.0, 7.0, 0.0}};
  drive_mat(scene, 0, along_x(Term(0.3) * now()));
  World world = make_world(scene);

  world.step();

  EXPECT_NEAR(world.link_force(2).x(), 0.3 * 7.0, 1e-12);
}

TEST(Drive, CountsJumpsAndNothingElse) {
  const auto jumps_of = [](TimeFunction function) {
    NetworkDescription scene = oscillator(0.1, 50.0, 0.2, 0.02, 0.0, 1e-3);
    drive_mat(scene, 0, std::move(function));
    World world = make_world(scene);
    std::uint32_t count = 0;
    for (int n = 0; n < 1000; ++n) count += world.step().drive_jumps;
    return count;
  };
  const auto step_at = [](double time, double way) {
    return three(Operation::kSelect, now() < Term(time), Term(0.0), Term(way));
  };
  EXPECT_EQ(jumps_of(along_x(step_at(0.1234, 1e-6))), 1u);
  EXPECT_EQ(jumps_of(along_x(step_at(0.1234, 1e-3) + step_at(0.5, -1e-3) + Term(0.1) * now())), 2u);
  EXPECT_EQ(jumps_of(along_x(Term(0.1) * sine(Term(200.0) * now()))), 0u);
  EXPECT_EQ(jumps_of(along_x(size(sine(Term(200.0) * now())))), 0u);  // kinks
  EXPECT_EQ(jumps_of(table({0.1, 0.102}, {0.0, 1.0}, false)), 0u);
  EXPECT_EQ(jumps_of(table({0.1, 0.1 + 1e-9}, {0.0, 1.0}, false)), 1u);
  EXPECT_EQ(jumps_of(along_x(step_at(1e-9, 0.1))), 1u) << "at the start";
  EXPECT_EQ(jumps_of(table({0.0, 0.7, 3.0}, {0.0, 0.0, 0.1}, false)), 0u) << "begins by rounding";
  const Term settles = Term(0.01) * (Term(1.0) - one(Operation::kExp, Term(-50.0) * now()));
  EXPECT_EQ(jumps_of(along_x(Term(0.3) + settles)), 0u) << "ends by rounding";
}

TEST(Drive, OfAJumpAtTheStartActsOnce) {
  NetworkDescription scene = oscillator(0.1, 0.0, 3.0, 0.0, 0.0, 1e-3);
  drive_mat(scene, 0, along_x(three(Operation::kSelect, now() < Term(1e-9), Term(0.0), Term(0.1))));
  World world = make_world(scene);
  run(world, 3);
  EXPECT_NEAR(world.velocity(1).x(), 3.0 * 0.1 / 0.1, 0.1);
}

TEST(Drive, StaysWhereItIsAndReportsWhatIsNotFinite) {
  NetworkDescription scene = oscillator(0.1, 50.0, 0.2, 0.02, 0.0, 1e-3);
  drive_mat(scene, 0,
            along_x(one(Operation::kSqrt, Term(0.0401) - now()) - Term(std::sqrt(0.0401))));
  push(scene, 1, along_x(Term(1.0) / (Term(0.0505) - now())));
  World world = make_world(scene);

  std::uint32_t refused = 0;
  double last = 0.0;
  for (int n = 0; n < 100; ++n) {
    const StepReport report = world.step();
    if (report.refused_drives == 0) last = world.position(0).x();
    refused += report.refused_drives;
    ASSERT_EQ(report.non_finite_mats, 0u);
  }

  EXPECT_EQ(refused, 60u);  // steps 41 to 100
  EXPECT_EQ(world.position(0).x(), last);
}

TEST(Drive, RefusesAStartThatContradictsIt) {
  NetworkDescription scene = oscillator(0.1, 50.0, 0.2, 0.02, 0.0, 1e-3);
  drive_mat(scene, 0, along_x(Term(0.01) * now()));
  scene.mats[0].position.x() = 1e-12;
  EXPECT_THROW(make_world(scene), std::invalid_argument);
  scene.mats[0].position.x() = 0.0;
  EXPECT_NO_THROW(make_world(scene));
  scene.integrator = IntegratorKind::kSymplectic4;
  EXPECT_THROW(make_world(scene), std::invalid_argument);
}

TEST(TimeFunction, OfASmoothTableStaysBetweenItsValuesWithoutAKink) {
  std::mt19937 random(11);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> time{uniform() - 0.5};
    std::vector<double> value{uniform()};
    const std::size_t count = 2 + random() % 8;
    while (time.size() < count) {
      time.push_back(time.back() + 0.01 + uniform());
      value.push_back(trial % 3 == 0 && uniform() < 0.5 ? value.back() : uniform() - 0.5);
    }
    const TimeFunction smooth = table(time, value, true);
    const TimeFunction straight = table(time, value, false);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_DOUBLE_EQ(value_at(smooth, time[i]).x(), value[i]);
      ASSERT_DOUBLE_EQ(value_at(straight, time[i]).x(), value[i]);
      constexpr double kMoment = 1e-7;
      const double before = (value[i] - value_at(smooth, time[i] - kMoment).x()) / kMoment;
      const double after = (value_at(smooth, time[i] + kMoment).x() - value[i]) / kMoment;
      // curvatures are below 10 / 0.01^2 m/s^2
      ASSERT_NEAR(before, after, 1e-2) << "trial " << trial;
      if (i == 0) continue;
      for (double share = 0.0; share <= 1.0; share += 0.01) {
        const double between = time[i - 1] + share * (time[i] - time[i - 1]);
        const double there = value_at(smooth, between).x();
        ASSERT_LE(std::min(value[i - 1], value[i]) - 1e-12, there);
        ASSERT_GE(std::max(value[i - 1], value[i]) + 1e-12, there);
        ASSERT_NEAR(value_at(straight, between).x(), std::lerp(value[i - 1], value[i], share),
                    1e-12);
      }
    }
  }
}

/// Formulas by chance, smooth over a second, 0 at 0 s.
class RandomFunctions {
 public:
  explicit RandomFunctions(std::uint32_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

  TimeFunction function(int dimension) {
    TimeFunction result;
    if (below(3) == 0) {
      result.smooth = below(2) == 0;
      for (int i = 0; i < 6; ++i) {
        result.time.push_back(0.1 * i + uniform(0.0, 0.09));
        Vec3 value = Vec3::Zero();
        for (int axis = 0; axis < dimension && i > 0; ++axis) value[axis] = uniform(-0.02, 0.02);
        result.value.push_back(value);
      }
      return result;
    }
    for (int axis = 0; axis < dimension; ++axis) {
      const Term whole = formula(2);
      const double at_start = value_at(along_x(whole), 0.0).x();
      result.formula[static_cast<std::size_t>(axis)] =
          (Term(uniform(0.0, 0.01)) * (whole - Term(at_start))).program;
    }
    return result;
  }

 private:
  Term formula(int levels) {
    const Term wave = sine(Term(uniform(1.0, 60.0)) * now() + Term(uniform(0.0, 6.0)));
    if (levels == 0) return below(2) == 0 ? wave : Term(uniform(-1.0, 1.0)) * now();
    switch (below(5)) {
      case 0:
        return formula(levels - 1) + formula(levels - 1);
      case 1:
        return formula(levels - 1) * formula(levels - 1);
      case 2:
        return one(Operation::kTanh, formula(levels - 1));
      case 3:
        return one(Operation::kExp, Term(-1.0) * size(formula(levels - 1)));
      default:
        return wave;
    }
  }

  std::mt19937 random_;
};

TEST(Drive, KeepsTheAccountAndTheBitsOfEveryRandomScene) {
  constexpr IntegratorKind kKinds[] = {IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                       IntegratorKind::kImplicit, IntegratorKind::kModal};
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomFunctions random(seed);
    const IntegratorKind kind = kKinds[seed % 4];
    const int dimension =
        kind == IntegratorKind::kModal ? 1 : 1 + static_cast<int>(random.below(3));
    NetworkDescription scene;
    scene.dimension = dimension;
    scene.step = 5e-4;
    scene.integrator = kind;
    scene.gravity = Vec3(random.uniform(-1.0, 1.0), 0, 0);
    for (std::uint32_t i = 0; i < 6; ++i) {
      Vec3 place = Vec3(0.05 * i, 0.0, 0.0);
      for (int axis = 1; axis < dimension; ++axis) place[axis] = random.uniform(0.0, 0.03);
      scene.mats.push_back(mass(random.uniform(0.05, 0.2), place));
    }
    const double viscosity = random.below(2) == 0 ? random.uniform(0.01, 0.2) : 0.0;
    for (std::uint32_t i = 0; i < 5; ++i) scene.links.push_back({i, i + 1, 100.0, viscosity, 0.05});
    scene.links.push_back({1, 4, 40.0, 0.4 * viscosity, 0.12});
    if (dimension == 1) {
      scene.maxwell_links.push_back({0, 3, 20.0, 0.5, 0.0});
    } else {
      scene.links.push_back({0, 3, 20.0, 0.2 * viscosity, 0.0, true});
    }
    drive_mat(scene, 0, random.function(dimension));
    if (random.below(2) == 0) push(scene, 2, random.function(dimension));
    drive_mat(scene, 5, random.function(dimension));

    World world = make_world(scene);
    // what `leapfrog` leaves is of second order, `implicit` takes energy
    const bool is_exact = kind == IntegratorKind::kCordis || kind == IntegratorKind::kModal;
    for (int n = 0; n < 500; ++n) world.step();
    const engine::Snapshot middle = world.snapshot();
    const AllocationGuard guard;
    for (int n = 0; n < 500; ++n) world.step();
    EXPECT_EQ(guard.count(), 0u);

    const Energy energy = world.energy();
    EXPECT_GT(energy.largest, 1e-9);
    if (kind != IntegratorKind::kImplicit) {
      EXPECT_LT(std::abs(energy.residual()), (is_exact ? 1e-10 : 2e-2) * energy.largest);
    }

    World later = make_world(scene);
    later.restore(middle);
    run(later, 500);
    EXPECT_EQ(later.state_hash(), world.state_hash());
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World other = make_world(scene, width);
      run(other, 1000);
      EXPECT_EQ(other.state_hash(), world.state_hash());
    }
  }
}

}  // namespace
}  // namespace cordis::test
