// tests/plan/convergence_test.cpp -- how fast each method comes near the truth, problem by problem
// of tests/reference. Prints a table:  plan_test --gtest_filter=Convergence.*
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "sim_node/plan/oracle.h"
#include "sim_node/plan/trial.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"
#include "tests/support/reference_data.h"

namespace cordis::test::convergence {
namespace {

/// What decides the order of a method.
enum class Kind { kConservative, kDamped, kSwitching };

struct Problem {
  std::string name;
  Kind kind;
  NetworkDescription network;
  double duration;  // [s]
  double rate_hz;   // the fixed rate at which errors are shown; order from it and 2, 4 times it
  /// What the reference says: {time, MAT, position along x}, ascending in time.
  std::vector<std::array<double, 3>> expected;
  double within =
      1e-8;  // of the reference: more where it is of a limit that the scene comes near [m]
};

double value(const nlohmann::json& params, const char* name) {
  return number(params[name]);
}

Problem damped_oscillator(const std::string& regime) {
  const nlohmann::json problem = reference("R01_damped_oscillator");
  const nlohmann::json& params = problem["params"];
  for (const auto& of : problem["cases"]) {
    if (of["name"] != regime) continue;
    Problem made{"R01 oscillator, " + regime,
                 Kind::kDamped,
                 oscillator(value(params, "m"), value(params, "k"), number(of["z"]),
                            value(params, "x0"), value(params, "v0"), 1e-2),
                 5.0,
                 100.0,
                 {}};
    if (number(of["z"]) == 0.0) made.kind = Kind::kConservative;
    for (const auto& row : of["t_x_v"]) {
      made.expected.push_back({number(row[0]), 1.0, number(row[1])});
    }
    return made;
  }
  throw std::runtime_error("R01 has no regime " + regime);
}

/// Masses along one line between two fixed ends; MAT 0 is the first end.
NetworkDescription chain(std::size_t count, double mass_kg, const engine::Link& link) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::size_t i = 0; i < count; ++i) scene.mats.push_back(mass(mass_kg, Vec3::Zero()));
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::uint32_t i = 0; i <= count; ++i) {
    scene.links.push_back({i, i + 1, link.stiffness, link.viscosity, 0.0});
  }
  return scene;
}

Problem chain_mode() {
  Problem made{"R03 chain of 10, mode 3",
               Kind::kConservative,
               chain(10, 1.0, {0, 1, 1.0, 0.0}),
               20.0,
               20.0,
               {}};
  const double w = number(reference("R03_chain_modes")["values"]["fixed-fixed_N10"][2]);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    made.network.mats[i].position.x() = std::sin(3.0 * M_PI * i / 11.0);
  }
  for (const double t : {5.0, 20.0}) {
    made.expected.push_back({t, 2.0, std::sin(6.0 * M_PI / 11.0) * std::cos(w * t)});
  }
  return made;
}

Problem membrane_mode() {
  const nlohmann::json problem = reference("R04_membrane_modes");
  constexpr std::uint32_t kRows = 6;
  constexpr std::uint32_t kColumns = 9;
  Problem made{"R04 membrane 6 x 9, mode 2 3", Kind::kConservative, {}, 20.0, 20.0, {}};
  made.network.dimension = 1;
  made.network.step = 1e-2;
  const auto at = [](std::uint32_t row, std::uint32_t column) {
    return row * (kColumns + 2) + column;
  };
  for (std::uint32_t row = 0; row < kRows + 2; ++row) {
    for (std::uint32_t column = 0; column < kColumns + 2; ++column) {
      const bool inside = row % (kRows + 1) != 0 && column % (kColumns + 1) != 0;
      const Vec3 place(
          std::sin(2.0 * M_PI * row / (kRows + 1)) * std::sin(3.0 * M_PI * column / (kColumns + 1)),
          0, 0);
      made.network.mats.push_back(inside ? mass(1.0, place) : fixed(Vec3::Zero()));
      const auto join = [&](std::uint32_t to) {
        made.network.links.push_back({to, at(row, column), 1.0, 0.0, 0.0});
      };
      if (row > 0 && column % (kColumns + 1) != 0) join(at(row - 1, column));
      if (column > 0 && row % (kRows + 1) != 0) join(at(row, column - 1));
    }
  }
  const double w = number(problem["w"][1][2]);
  for (const double t : {5.0, 20.0}) {
    made.expected.push_back({t, static_cast<double>(at(1, 2)),
                             made.network.mats[at(1, 2)].position.x() * std::cos(w * t)});
  }
  return made;
}

Problem plucked_string() {
  const nlohmann::json problem = reference("R05_plucked_string");
  const nlohmann::json& params = problem["params"];
  Problem made{"R05 plucked string",
               Kind::kDamped,
               chain(20, value(params, "m"), {0, 1, value(params, "k"), value(params, "z_link")}),
               0.1,
               20000.0,
               {}};
  made.network.medium_viscosity = value(params, "z_ground");
  for (int i = 1; i <= 20; ++i) {
    const double share = i <= 6 ? i / 6.0 : (21 - i) / 15.0;
    made.network.mats[static_cast<std::size_t>(i)].position.x() = value(params, "amp") * share;
  }
  for (const auto& row : problem["t_x_v_at_mass"]["6"]) {
    if (number(row[0]) <= made.duration) {
      made.expected.push_back({number(row[0]), 6.0, number(row[1])});
    }
  }
  return made;
}

Problem two_bodies() {
  const nlohmann::json problem = reference("R06_two_bodies");
  const nlohmann::json& params = problem["params"];
  Problem made{"R06 two bodies", Kind::kDamped, {}, 3.0, 200.0, {}};
  made.network.dimension = 1;
  made.network.step = 1e-3;
  for (const char* end : {"1", "2"}) {
    const std::string i = end;
    made.network.mats.push_back(mass(value(params, ("m" + i).c_str()),
                                     Vec3(value(params, ("x" + i).c_str()), 0, 0),
                                     Vec3(value(params, ("v" + i).c_str()), 0, 0)));
  }
  made.network.links = {{0, 1, value(params, "k"), value(params, "z"), value(params, "L0")}};
  for (const auto& row : problem["t_x1_x2_v1_v2"]) {
    made.expected.push_back({number(row[0]), 1.0, number(row[2])});
  }
  return made;
}

engine::Law power(double coefficient, double exponent) {
  engine::Law law;
  law.kind = engine::Law::Kind::kPower;
  law.coefficient = coefficient;
  law.exponent = exponent;
  return law;
}

NetworkDescription with_law(NetworkDescription scene, const engine::Behaviour& behaviour) {
  scene.links.clear();
  scene.behaviours = {behaviour};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

Problem duffing() {
  Problem made{"R07 cubic spring",
               Kind::kConservative,
               with_law(oscillator(1.0, 0.0, 0.0, 2.0, 0.0, 1e-2), behaviour(1.0, power(0.5, 3.0))),
               20.0,
               50.0,
               {}};
  for (const auto& row : reference("R07_duffing")["t_x"]) {
    made.expected.push_back({number(row[0]), 1.0, number(row[1])});
  }
  return made;
}

Problem stiff_fpu() {
  const nlohmann::json problem = reference("R09_stiff_fpu_hairer");
  Problem made{"R09 stiff and soft chain", Kind::kConservative, chain(6, 1.0, {}), 1.0, 1000.0, {}};
  made.network.links.clear();
  made.network.behaviours = {behaviour(0.0, power(4.0, 3.0))};
  for (std::uint32_t i = 0; i < 7; ++i) {
    if (i % 2 == 0) {
      made.network.state_links.push_back({i, i + 1, 0, 0.0});
    } else {
      made.network.links.push_back({i, i + 1, 50.0 * 50.0 / 2.0, 0.0, 0.0});
    }
    if (i == 6) continue;
    made.network.mats[i + 1].position.x() = number(problem["initial_q"][i]);
    made.network.mats[i + 1].velocity.x() = number(problem["initial_p"][i]);
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    made.expected.push_back({1.0, i + 1.0, number(problem["rows"][0]["q"][i])});
  }
  return made;
}

/// d + alpha d^2
class QuadraticSpring final : public engine::LinkFunction {
 public:
  explicit QuadraticSpring(double alpha) : alpha_(alpha) {}
  double operator()(double, double elongation, double, double, double) const noexcept override {
    return elongation + alpha_ * elongation * elongation;
  }

 private:
  double alpha_;
};

/// The first 20 s: its reference is the energy of its modes much later, which nonlinear_test holds.
Problem quadratic_chain() {
  const nlohmann::json params = reference("R10_fpu_alpha")["params"];
  Problem made{
      "R10 chain of 32, quadratic", Kind::kConservative, chain(32, 1.0, {}), 20.0, 20.0, {}};
  made.network.links.clear();
  engine::Law law;
  law.kind = engine::Law::Kind::kFunction;
  law.function = std::make_shared<const QuadraticSpring>(value(params, "alpha"));
  made.network.behaviours = {behaviour(0.0, law)};
  for (std::uint32_t i = 0; i < 33; ++i) {
    made.network.state_links.push_back({i, i + 1, 0, 0.0});
    made.network.mats[i].position.x() = i > 0 ? std::sin(M_PI * i / 33.0) : 0.0;
  }
  return made;
}

engine::Law lennard_jones() {
  engine::Law law;
  law.kind = engine::Law::Kind::kLennardJones;
  law.depth = 1.0;
  law.diameter = 1.0;
  return law;
}

Problem dimer() {
  // Half of the energy of the well: after one period it is where it was.
  const nlohmann::json row = reference("R11_lennard_jones")["dimer"]["period_vs_energy"][2];
  const double start = number(row[3]);
  const double period = number(row[1]);
  Problem made{"R11 Lennard-Jones dimer", Kind::kConservative, {}, period, 500.0, {}};
  made.network.dimension = 2;
  made.network.step = 1e-3;
  made.network.mats = {mass(1.0, Vec3::Zero()), mass(1.0, Vec3(start, 0, 0))};
  made.network.behaviours = {behaviour(0.0, lennard_jones())};
  made.network.state_links = {{0, 1, 0, 0.0}};
  made.expected = {{period, 1.0, start}};
  return made;
}

/// Touches below the rest length; `pulls`: also while it lets go, else it lets go at no force.
engine::Behaviour touch(double stiffness, double viscosity, bool pulls) {
  using engine::Operation;
  using engine::Quantity;
  engine::Behaviour made;
  made.states.resize(2);
  made.exits.resize(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    made.states[i].first_exit = i;
    made.states[i].last_exit = i + 1;
    made.exits[i].target = 1 - i;
    made.exits[i].when.code = {
        {Operation::kQuantity, Quantity::kElongation, 0.0, 0},
        {Operation::kConstant, Quantity::kElongation, 0.0, 0},
        {i == 0 ? Operation::kLess : Operation::kGreaterOrEqual, Quantity::kElongation, 0.0, 0}};
  }
  made.states[1].stiffness = stiffness;
  made.states[1].viscosity = viscosity;
  made.states[1].pulls = pulls;
  return made;
}

Problem bounce() {
  // K = m = 1, v0 = 1, zeta = 0.1.
  const nlohmann::json row = reference("R12_bounce_restitution")["rows"][3];
  // Of its position the reference says nothing: see OfABounceGoesToItsRestitution.
  return {
      "R12 bounce, clamped",
      Kind::kSwitching,
      with_law(oscillator(1.0, 0.0, 0.0, 1.0, -1.0, 1e-2), touch(1.0, 2.0 * number(row[0]), false)),
      6.0,
      50.0,
      {}};
}

Problem hertz() {
  const nlohmann::json problem = reference("R13_hertz_bounce");
  engine::Behaviour skin = behaviour(0.0, power(value(problem["params"], "K"), 1.5));
  skin.states[0].pulls = false;
  Problem made{"R13 Hertz bounce",
               Kind::kSwitching,
               with_law(oscillator(value(problem["params"], "m"), 0.0, 0.0, 0.0,
                                   -value(problem["params"], "v"), 1e-3),
                        skin),
               0.02,
               20000.0,
               {}};
  const double contact_time = number(problem["t_c"]);
  made.expected = {{0.5 * contact_time, 1.0, -number(problem["d_max"])},
                   {0.02, 1.0, 0.02 - contact_time}};
  return made;
}

Problem bouncing_ball() {
  const nlohmann::json problem = reference("R14_bouncing_ball");
  const nlohmann::json& params = problem["params"];
  Problem made{"R14 bouncing ball",
               Kind::kSwitching,
               with_law(oscillator(value(params, "m"), 0.0, 0.0, value(params, "h0"), 0.0, 1e-3),
                        touch(value(params, "K"), value(params, "Z"), false)),
               1.5,
               5000.0,
               {}};
  made.network.gravity = Vec3(-value(params, "g"), 0, 0);
  const auto& impacts = problem["impact_times_clamped"];
  made.expected = {{number(impacts[0]), 1.0, 0.0}, {number(impacts[1]), 1.0, 0.0}};
  return made;
}

Problem standard_linear_solid() {
  const nlohmann::json params = reference("R16_rheology")["params"];
  Problem made{"R16 standard linear solid",
               Kind::kDamped,
               oscillator(0.5, value(params, "K1"), 0.0, 0.1, 0.0, 1e-3),
               1.0,
               1000.0,
               {}};
  made.network.maxwell_links = {{0, 1, value(params, "K2"), value(params, "Z")}};
  return made;
}

engine::Law always(double pull) {
  engine::Law law;
  law.kind = engine::Law::Kind::kTable;
  law.table = {{0.0}, {pull}};
  return law;
}

/// A block on a spring under a belt, from where it is farthest on. It sticks by a spring so stiff
/// that it is left behind by 0.04 mm at most.
Problem stick_slip() {
  const nlohmann::json problem = reference("R15_stick_slip_coulomb");
  const nlohmann::json& params = problem["params"];
  const double stiffness = value(params, "k");
  const double speed = value(params, "V");
  const double slipping = value(params, "Fk");
  constexpr double kSticking = 1e5;  // [N/m]
  const double swing = value(problem, "x_max") - slipping / stiffness;
  const double w = std::sqrt(stiffness / value(params, "m"));
  const double hooks = 2.0 * slipping / stiffness - value(params, "Fs") / stiffness;  // x there
  const double hooked_at = value(problem, "period") - value(problem, "t_stick") -
                           std::acos((value(params, "Fs") - slipping) / stiffness / swing) / w;

  Problem made{"R15 stick and slip", Kind::kSwitching, {}, value(problem, "period"), 500.0, {}};
  made.network.dimension = 1;
  made.network.step = 1e-4;
  made.network.mats = {fixed(Vec3::Zero()),
                       mass(value(params, "m"), Vec3(value(problem, "x_max"), 0, 0)),
                       mass(1e9, Vec3::Zero(), Vec3(speed, 0, 0))};
  made.network.links = {{0, 1, stiffness, 0.0, 0.0}};
  engine::LinkState slip;
  slip.elasticity = always(slipping);
  engine::LinkState stick;
  stick.stiffness = kSticking;
  stick.viscosity = 60.0;
  Behaving rosin;
  rosin.state(slip)
      .exit_to_rest(both(q(Quantity::kSpeed) < 0.0, q(Quantity::kAge) > 0.1), 1,
                    q(Quantity::kDistance) - hooks * stiffness / kSticking)
      .state(stick)
      .exit(q(Quantity::kElongation) > value(params, "Fs") / kSticking, 0);
  made.network.behaviours = {rosin.behaviour};
  made.network.state_links = {{1, 2, 0, 0.0}};
  made.expected = {{0.2, 1.0, slipping / stiffness + swing * std::cos(0.2 * w)},
                   {0.6, 1.0, hooks + speed * (0.6 - hooked_at)},
                   {made.duration, 1.0, value(problem, "x_max")}};
  made.within = 1e-4;
  return made;
}

Problem rupture() {
  const nlohmann::json of = reference("R17_hysteresis")["rupture"];
  Problem made{"R17 rupture", Kind::kSwitching, {}, 0.1, 2000.0, {}};
  made.network.dimension = 1;
  made.network.step = 1e-4;
  made.network.mats = {mass(value(of, "m"), Vec3::Zero()),
                       mass(1e12, Vec3::Zero(), Vec3(value(of, "V"), 0, 0))};
  Behaving thread;
  thread.state(value(of, "k")).exit(q(Quantity::kElongation) > value(of, "ub"), 1).state(0.0);
  made.network.behaviours = {thread.behaviour};
  made.network.state_links = {{0, 1, 0, 0.0}};
  made.expected = {
      {0.1, 0.0, value(of, "x_break") + value(of, "v_break") * (0.1 - value(of, "t_break"))}};
  return made;
}

/// A rod is the limit of a stiff spring: of 1 mm, by its own weight, here.
Problem pendulum() {
  const nlohmann::json row = reference("R18_rigid_pendulum_limit")["theta0_period"][2];
  const double angle = number(row[0]);
  Problem made{"R18 pendulum", Kind::kConservative, {}, number(row[1]), 1000.0, {}};
  made.network.dimension = 2;
  made.network.step = 1e-3;
  made.network.gravity = Vec3(0, -9.81, 0);
  made.network.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(std::sin(angle), -std::cos(angle), 0))};
  made.network.links = {{0, 1, 1e4, 0.0, 1.0}};
  made.expected = {{made.duration, 1.0, std::sin(angle)}};
  made.within = 5e-3;
  return made;
}

Problem collision() {
  const nlohmann::json of = reference("R19_collisions")["case"];
  Problem made{"R19 two balls", Kind::kSwitching, {}, 0.05, 20000.0, {}};
  made.network.dimension = 2;
  made.network.step = 1e-3;
  made.network.mats = {mass(value(of, "m1"), Vec3::Zero(), Vec3(value(of, "v1"), 0, 0)),
                       mass(value(of, "m2"), Vec3(0.05, 0, 0))};
  made.network.behaviours = {touch(value(of, "K"), value(of, "Z"), true)};
  made.network.state_links = {{0, 1, 0, 0.04}};
  return made;
}

Problem cluster() {
  const nlohmann::json problem = reference("R22_lammps_cluster");
  Problem made{"R22 64 Lennard-Jones balls", Kind::kConservative, {}, 0.25, 400.0, {}};
  made.network.dimension = 3;
  made.network.step = 1e-3;
  for (const auto& row : problem["step_0"]) {
    const auto at = [&row](std::size_t i) { return number(row[i]); };
    made.network.mats.push_back(mass(1.0, Vec3(at(0), at(1), at(2)), Vec3(at(3), at(4), at(5))));
  }
  made.network.behaviours = {behaviour(0.0, lennard_jones())};
  std::vector<std::uint32_t> all(made.network.mats.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  made.network.sets = {{0, all, {}, 30.0, 0.0}};
  return made;
}

/// One for each of tests/reference but: R02, which is the recurrence of `cordis` itself and not of
/// an equation (recurrence_test); R08, a number that was not given; R20 and R21, which are limits
/// and not motions (port_limit_test, integrator_limit_test).
std::vector<Problem> problems() {
  std::vector<Problem> all;
  const nlohmann::json oscillators = reference("R01_damped_oscillator");
  for (const auto& of : oscillators["cases"]) all.push_back(damped_oscillator(of["name"]));
  for (const auto& make :
       {chain_mode, membrane_mode, plucked_string, two_bodies, duffing, stiff_fpu, quadratic_chain,
        dimer, bounce, hertz, bouncing_ball, stick_slip, standard_linear_solid, rupture, pendulum,
        collision, cluster}) {
    all.push_back(make());
  }
  return all;
}

/// The order that a method is to show at least; none where it is not known, or shows none.
std::map<std::string, std::map<Kind, double>> least_orders() {
  // Where a change falls between two steps errors are uneven: that they fall is all there is.
  constexpr double kFalls = 0.0;
  constexpr double kCoarse = 0.75;  // `implicit`, at steps at which it damps most of the motion
  using enum Kind;
  return {{"cordis", {{kConservative, 2.0}, {kDamped, 1.0}, {kSwitching, kFalls}}},
          {"leapfrog", {{kConservative, 2.0}, {kDamped, 2.0}, {kSwitching, kFalls}}},
          {"symplectic4", {{kConservative, 4.0}, {kDamped, 4.0}, {kSwitching, kFalls}}},
          {"implicit", {{kConservative, kCoarse}, {kDamped, kCoarse}, {kSwitching, kFalls}}}};
}

/// From an error to that at four times the rate.
double order_of(double error, double finer) {
  return 0.5 * std::log2(error / finer);
}

TEST(Convergence, OfEveryMethodOnEveryProblem) {
  const std::map<std::string, std::map<Kind, double>> least = least_orders();
  const std::vector<std::string> methods = plan::integrator_names();
  std::printf("%-28s %9s", "order, error at", "rate_hz");
  for (const std::string& method : methods) std::printf(" %20s", method.c_str());
  std::printf("\n");
  for (const Problem& problem : problems()) {
    constexpr int kSamples = 25;
    constexpr double kFloor = 3e-10;  // below it the reference itself is in doubt
    const double steps = 4.0 * std::ceil(0.25 * problem.rate_hz * problem.duration / kSamples);
    const plan::Sampling sampling{problem.duration / kSamples, kSamples};
    const double rate = steps / sampling.period;
    const plan::Course nothing;
    const plan::Reference reference =
        plan::make_reference(problem.network, nothing, {sampling, 1e-11, 60.0, 0.0, {}});
    ASSERT_TRUE(reference.by_oracle) << problem.name;
    ASSERT_EQ(reference.compared, kSamples) << problem.name;

    std::printf("%-28s %9.4g", problem.name.c_str(), rate);
    for (const std::string& method : methods) {
      if (!plan::refusal_of(problem.network, method).empty()) {
        std::printf(" %20s", "-");
        continue;
      }
      const auto error_at = [&](double rate_hz) {
        const plan::TrialResult run =
            plan::try_out(problem.network, method, rate_hz, nothing, reference);
        EXPECT_FALSE(run.blown_up) << problem.name << " with " << method;
        return run.error;
      };
      // A method of high order is at the floor of the reference at four times the rate.
      const bool high = method == "symplectic4";
      const double error = error_at(rate);
      const double other = error_at(high ? 0.25 * rate : 4.0 * rate);
      const double order = high ? order_of(other, error) : order_of(error, other);
      std::printf("      %5.2f  %8.2e", order, error);
      const auto known = least.find(method);
      if (known == least.end() || error < kFloor) continue;
      EXPECT_GT(order, known->second.at(problem.kind) - 0.15) << problem.name << " with " << method;
    }
    std::printf("\n");
  }
}

TEST(Convergence, GoesToWhatTheReferencesSay) {
  for (const Problem& problem : problems()) {
    plan::Oracle oracle(problem.network, 1e-12);
    for (const auto& [time, mat, x] : problem.expected) {
      oracle.advance_to(time);
      EXPECT_NEAR(oracle.position(static_cast<std::uint32_t>(mat)).x(), x, problem.within)
          << problem.name << " at " << time;
    }
  }
}

TEST(Convergence, OfABounceGoesToItsRestitution) {
  plan::Oracle wall(bounce().network, 1e-12);
  wall.advance_to(6.0);
  EXPECT_NEAR(wall.velocity(1).x(), number(reference("R12_bounce_restitution")["rows"][3][3]),
              1e-9);
  plan::Oracle balls(collision().network, 1e-12);
  balls.advance_to(0.05);
  const nlohmann::json of = reference("R19_collisions")["case"];
  EXPECT_NEAR(balls.velocity(0).x(), value(of, "v1p"), 1e-9);
  EXPECT_NEAR(balls.velocity(1).x(), value(of, "v2p"), 1e-9);
}

}  // namespace
}  // namespace cordis::test::convergence
