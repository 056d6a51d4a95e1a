// tests/plan/reference_problems.cpp
#include "tests/plan/reference_problems.h"

#include <cmath>

#include "tests/engine/programs.h"
#include "tests/support/reference_data.h"

namespace cordis::test::convergence {
namespace {

double value(const nlohmann::json& params, const char* name) {
  return number(params[name]);
}

ReferenceProblem damped_oscillator(const std::string& regime) {
  const nlohmann::json data = reference("R01_damped_oscillator");
  const nlohmann::json& params = data["params"];
  for (const auto& entry : data["cases"]) {
    if (entry["name"] != regime) continue;
    ReferenceProblem problem{"R01 oscillator, " + regime,
                             MotionKind::kDamped,
                             oscillator(value(params, "m"), value(params, "k"), number(entry["z"]),
                                        value(params, "x0"), value(params, "v0"), 1e-2),
                             5.0,
                             100.0,
                             {}};
    if (number(entry["z"]) == 0.0) problem.kind = MotionKind::kConservative;
    for (const auto& row : entry["t_x_v"]) {
      problem.expected.push_back({number(row[0]), 1.0, number(row[1])});
    }
    return problem;
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

ReferenceProblem chain_mode() {
  ReferenceProblem problem{"R03 chain of 10, mode 3",
                           MotionKind::kConservative,
                           chain(10, 1.0, {0, 1, 1.0, 0.0}),
                           20.0,
                           20.0,
                           {}};
  const double w = number(reference("R03_chain_modes")["values"]["fixed-fixed_N10"][2]);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    problem.network.mats[i].position.x() = std::sin(3.0 * M_PI * i / 11.0);
  }
  for (const double t : {5.0, 20.0}) {
    problem.expected.push_back({t, 2.0, std::sin(6.0 * M_PI / 11.0) * std::cos(w * t)});
  }
  return problem;
}

ReferenceProblem membrane_mode() {
  const nlohmann::json data = reference("R04_membrane_modes");
  constexpr std::uint32_t kRows = 6;
  constexpr std::uint32_t kColumns = 9;
  ReferenceProblem problem{
      "R04 membrane 6 x 9, mode 2 3", MotionKind::kConservative, {}, 20.0, 20.0, {}};
  problem.network.dimension = 1;
  problem.network.step = 1e-2;
  const auto mat = [](std::uint32_t row, std::uint32_t column) {
    return row * (kColumns + 2) + column;
  };
  for (std::uint32_t row = 0; row < kRows + 2; ++row) {
    for (std::uint32_t column = 0; column < kColumns + 2; ++column) {
      const bool inside = row % (kRows + 1) != 0 && column % (kColumns + 1) != 0;
      const Vec3 place(
          std::sin(2.0 * M_PI * row / (kRows + 1)) * std::sin(3.0 * M_PI * column / (kColumns + 1)),
          0, 0);
      problem.network.mats.push_back(inside ? mass(1.0, place) : fixed(Vec3::Zero()));
      const auto join = [&](std::uint32_t neighbour) {
        problem.network.links.push_back({neighbour, mat(row, column), 1.0, 0.0, 0.0});
      };
      if (row > 0 && column % (kColumns + 1) != 0) join(mat(row - 1, column));
      if (column > 0 && row % (kRows + 1) != 0) join(mat(row, column - 1));
    }
  }
  const double w = number(data["w"][1][2]);
  for (const double t : {5.0, 20.0}) {
    problem.expected.push_back({t, static_cast<double>(mat(1, 2)),
                                problem.network.mats[mat(1, 2)].position.x() * std::cos(w * t)});
  }
  return problem;
}

ReferenceProblem plucked_string() {
  const nlohmann::json data = reference("R05_plucked_string");
  const nlohmann::json& params = data["params"];
  ReferenceProblem problem{
      "R05 plucked string",
      MotionKind::kDamped,
      chain(20, value(params, "m"), {0, 1, value(params, "k"), value(params, "z_link")}),
      0.1,
      20000.0,
      {}};
  problem.network.medium_viscosity = value(params, "z_ground");
  for (int i = 1; i <= 20; ++i) {
    const double share = i <= 6 ? i / 6.0 : (21 - i) / 15.0;
    problem.network.mats[static_cast<std::size_t>(i)].position.x() = value(params, "amp") * share;
  }
  for (const auto& row : data["t_x_v_at_mass"]["6"]) {
    if (number(row[0]) <= problem.duration) {
      problem.expected.push_back({number(row[0]), 6.0, number(row[1])});
    }
  }
  return problem;
}

ReferenceProblem two_bodies() {
  const nlohmann::json data = reference("R06_two_bodies");
  const nlohmann::json& params = data["params"];
  ReferenceProblem problem{"R06 two bodies", MotionKind::kDamped, {}, 3.0, 200.0, {}};
  problem.network.dimension = 1;
  problem.network.step = 1e-3;
  for (const char* end : {"1", "2"}) {
    const std::string i = end;
    problem.network.mats.push_back(mass(value(params, ("m" + i).c_str()),
                                        Vec3(value(params, ("x" + i).c_str()), 0, 0),
                                        Vec3(value(params, ("v" + i).c_str()), 0, 0)));
  }
  problem.network.links = {{0, 1, value(params, "k"), value(params, "z"), value(params, "L0")}};
  for (const auto& row : data["t_x1_x2_v1_v2"]) {
    problem.expected.push_back({number(row[0]), 1.0, number(row[2])});
  }
  return problem;
}

engine::Law power(double coefficient, double exponent) {
  return engine::Power{coefficient, exponent};
}

NetworkDescription with_law(NetworkDescription scene, const engine::StateMachine& state_machine) {
  scene.links.clear();
  scene.state_machines = {state_machine};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

ReferenceProblem duffing() {
  ReferenceProblem problem{
      "R07 cubic spring",
      MotionKind::kConservative,
      with_law(oscillator(1.0, 0.0, 0.0, 2.0, 0.0, 1e-2), state_machine(1.0, power(0.5, 3.0))),
      20.0,
      50.0,
      {}};
  for (const auto& row : reference("R07_duffing")["t_x"]) {
    problem.expected.push_back({number(row[0]), 1.0, number(row[1])});
  }
  return problem;
}

ReferenceProblem stiff_fpu() {
  const nlohmann::json data = reference("R09_stiff_fpu_hairer");
  ReferenceProblem problem{
      "R09 stiff and soft chain", MotionKind::kConservative, chain(6, 1.0, {}), 1.0, 1000.0, {}};
  problem.network.links.clear();
  problem.network.state_machines = {state_machine(0.0, power(4.0, 3.0))};
  for (std::uint32_t i = 0; i < 7; ++i) {
    if (i % 2 == 0) {
      problem.network.state_links.push_back({i, i + 1, 0, 0.0});
    } else {
      problem.network.links.push_back({i, i + 1, 50.0 * 50.0 / 2.0, 0.0, 0.0});
    }
    if (i == 6) continue;
    problem.network.mats[i + 1].position.x() = number(data["initial_q"][i]);
    problem.network.mats[i + 1].velocity.x() = number(data["initial_p"][i]);
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    problem.expected.push_back({1.0, i + 1.0, number(data["rows"][0]["q"][i])});
  }
  return problem;
}

/// The first 20 s: its reference is the energy of its modes much later, which nonlinear_test holds.
ReferenceProblem quadratic_chain() {
  const nlohmann::json params = reference("R10_fpu_alpha")["params"];
  ReferenceProblem problem{
      "R10 chain of 32, quadratic", MotionKind::kConservative, chain(32, 1.0, {}), 20.0, 20.0, {}};
  problem.network.links.clear();
  const Term d = q(Quantity::kElongation);
  const engine::Law law = expression_law(d + value(params, "alpha") * d * d);
  problem.network.state_machines = {state_machine(0.0, law)};
  for (std::uint32_t i = 0; i < 33; ++i) {
    problem.network.state_links.push_back({i, i + 1, 0, 0.0});
    problem.network.mats[i].position.x() = i > 0 ? std::sin(M_PI * i / 33.0) : 0.0;
  }
  return problem;
}

engine::Law lennard_jones() {
  return engine::LennardJones{1.0, 1.0};
}

ReferenceProblem dimer() {
  // Half of the energy of the well: after one period it is where it was.
  const nlohmann::json row = reference("R11_lennard_jones")["dimer"]["period_vs_energy"][2];
  const double start = number(row[3]);
  const double period = number(row[1]);
  ReferenceProblem problem{
      "R11 Lennard-Jones dimer", MotionKind::kConservative, {}, period, 500.0, {}};
  problem.network.dimension = 2;
  problem.network.step = 1e-3;
  problem.network.mats = {mass(1.0, Vec3::Zero()), mass(1.0, Vec3(start, 0, 0))};
  problem.network.state_machines = {state_machine(0.0, lennard_jones())};
  problem.network.state_links = {{0, 1, 0, 0.0}};
  problem.expected = {{period, 1.0, start}};
  return problem;
}

/// Touches below the rest length; `pulls`: also while it lets go, else it lets go at no force.
engine::StateMachine touch(double stiffness, double viscosity, bool pulls) {
  const Term elongation = q(Quantity::kElongation);
  engine::StateMachine machine = Behaving()
                                     .state(0.0)
                                     .exit(elongation < 0.0, 1)
                                     .state(stiffness, viscosity)
                                     .exit(elongation >= 0.0, 0)
                                     .state_machine;
  machine.states[1].pulls = pulls;
  return machine;
}

ReferenceProblem hertz() {
  const nlohmann::json data = reference("R13_hertz_bounce");
  engine::StateMachine skin = state_machine(0.0, power(value(data["params"], "K"), 1.5));
  skin.states[0].pulls = false;
  ReferenceProblem problem{"R13 Hertz bounce",
                           MotionKind::kSwitching,
                           with_law(oscillator(value(data["params"], "m"), 0.0, 0.0, 0.0,
                                               -value(data["params"], "v"), 1e-3),
                                    skin),
                           0.02,
                           20000.0,
                           {}};
  const double contact_time = number(data["t_c"]);
  problem.expected = {{0.5 * contact_time, 1.0, -number(data["d_max"])},
                      {0.02, 1.0, 0.02 - contact_time}};
  return problem;
}

ReferenceProblem bouncing_ball() {
  const nlohmann::json data = reference("R14_bouncing_ball");
  const nlohmann::json& params = data["params"];
  ReferenceProblem problem{
      "R14 bouncing ball",
      MotionKind::kSwitching,
      with_law(oscillator(value(params, "m"), 0.0, 0.0, value(params, "h0"), 0.0, 1e-3),
               touch(value(params, "K"), value(params, "Z"), false)),
      1.5,
      5000.0,
      {}};
  problem.network.gravity = Vec3(-value(params, "g"), 0, 0);
  const auto& impacts = data["impact_times_clamped"];
  problem.expected = {{number(impacts[0]), 1.0, 0.0}, {number(impacts[1]), 1.0, 0.0}};
  return problem;
}

ReferenceProblem standard_linear_solid() {
  const nlohmann::json params = reference("R16_rheology")["params"];
  ReferenceProblem problem{"R16 standard linear solid",
                           MotionKind::kDamped,
                           oscillator(0.5, value(params, "K1"), 0.0, 0.1, 0.0, 1e-3),
                           1.0,
                           1000.0,
                           {}};
  problem.network.maxwell_links = {{0, 1, value(params, "K2"), value(params, "Z")}};
  return problem;
}

engine::Law always(double tension) {
  return engine::Table{{0.0}, {tension}};
}

/// A block on a spring under a belt, from where it is farthest on. It sticks by a spring so stiff
/// that it is left behind by 0.04 mm at most.
ReferenceProblem stick_slip() {
  const nlohmann::json data = reference("R15_stick_slip_coulomb");
  const nlohmann::json& params = data["params"];
  const double stiffness = value(params, "k");
  const double speed = value(params, "V");
  const double slipping = value(params, "Fk");
  constexpr double kSticking = 1e5;  // [N/m]
  const double swing = value(data, "x_max") - slipping / stiffness;
  const double w = std::sqrt(stiffness / value(params, "m"));
  const double hooks = 2.0 * slipping / stiffness - value(params, "Fs") / stiffness;  // x there
  const double hooked_at = value(data, "period") - value(data, "t_stick") -
                           std::acos((value(params, "Fs") - slipping) / stiffness / swing) / w;

  ReferenceProblem problem{
      "R15 stick and slip", MotionKind::kSwitching, {}, value(data, "period"), 500.0, {}};
  problem.network.dimension = 1;
  problem.network.step = 1e-4;
  problem.network.mats = {fixed(Vec3::Zero()),
                          mass(value(params, "m"), Vec3(value(data, "x_max"), 0, 0)),
                          mass(1e9, Vec3::Zero(), Vec3(speed, 0, 0))};
  problem.network.links = {{0, 1, stiffness, 0.0, 0.0}};
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
  problem.network.state_machines = {rosin.state_machine};
  problem.network.state_links = {{1, 2, 0, 0.0}};
  problem.expected = {{0.2, 1.0, slipping / stiffness + swing * std::cos(0.2 * w)},
                      {0.6, 1.0, hooks + speed * (0.6 - hooked_at)},
                      {problem.duration, 1.0, value(data, "x_max")}};
  problem.within = 1e-4;
  return problem;
}

ReferenceProblem rupture() {
  const nlohmann::json params = reference("R17_hysteresis")["rupture"];
  ReferenceProblem problem{"R17 rupture", MotionKind::kSwitching, {}, 0.1, 2000.0, {}};
  problem.network.dimension = 1;
  problem.network.step = 1e-4;
  problem.network.mats = {mass(value(params, "m"), Vec3::Zero()),
                          mass(1e12, Vec3::Zero(), Vec3(value(params, "V"), 0, 0))};
  Behaving thread;
  thread.state(value(params, "k"))
      .exit(q(Quantity::kElongation) > value(params, "ub"), 1)
      .state(0.0);
  problem.network.state_machines = {thread.state_machine};
  problem.network.state_links = {{0, 1, 0, 0.0}};
  problem.expected = {
      {0.1, 0.0,
       value(params, "x_break") + value(params, "v_break") * (0.1 - value(params, "t_break"))}};
  return problem;
}

/// A rod is the limit of a stiff spring: of 1 mm, by its own weight, here.
ReferenceProblem pendulum() {
  const nlohmann::json row = reference("R18_rigid_pendulum_limit")["theta0_period"][2];
  const double angle = number(row[0]);
  ReferenceProblem problem{
      "R18 pendulum", MotionKind::kConservative, {}, number(row[1]), 1000.0, {}};
  problem.network.dimension = 2;
  problem.network.step = 1e-3;
  problem.network.gravity = Vec3(0, -9.81, 0);
  problem.network.mats = {fixed(Vec3::Zero()),
                          mass(1.0, Vec3(std::sin(angle), -std::cos(angle), 0))};
  problem.network.links = {{0, 1, 1e4, 0.0, 1.0}};
  problem.expected = {{problem.duration, 1.0, std::sin(angle)}};
  problem.within = 5e-3;
  return problem;
}

ReferenceProblem cluster() {
  const nlohmann::json data = reference("R22_lammps_cluster");
  ReferenceProblem problem{
      "R22 64 Lennard-Jones balls", MotionKind::kConservative, {}, 0.25, 400.0, {}};
  problem.network.dimension = 3;
  problem.network.step = 1e-3;
  for (const auto& row : data["step_0"]) {
    const auto coordinate = [&row](std::size_t i) { return number(row[i]); };
    problem.network.mats.push_back(mass(1.0, Vec3(coordinate(0), coordinate(1), coordinate(2)),
                                        Vec3(coordinate(3), coordinate(4), coordinate(5))));
  }
  problem.network.state_machines = {state_machine(0.0, lennard_jones())};
  std::vector<std::uint32_t> all(problem.network.mats.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  problem.network.sets = {{0, all, {}, 30.0, 0.0}};
  return problem;
}

}  // namespace

ReferenceProblem bounce() {
  // K = m = 1, v0 = 1, zeta = 0.1.
  const nlohmann::json row = reference("R12_bounce_restitution")["rows"][3];
  // The reference gives no position: see OfABounceGoesToItsRestitution.
  return {
      "R12 bounce, clamped",
      MotionKind::kSwitching,
      with_law(oscillator(1.0, 0.0, 0.0, 1.0, -1.0, 1e-2), touch(1.0, 2.0 * number(row[0]), false)),
      6.0,
      50.0,
      {}};
}

ReferenceProblem collision() {
  const nlohmann::json params = reference("R19_collisions")["case"];
  ReferenceProblem problem{"R19 two balls", MotionKind::kSwitching, {}, 0.05, 20000.0, {}};
  problem.network.dimension = 2;
  problem.network.step = 1e-3;
  problem.network.mats = {mass(value(params, "m1"), Vec3::Zero(), Vec3(value(params, "v1"), 0, 0)),
                          mass(value(params, "m2"), Vec3(0.05, 0, 0))};
  problem.network.state_machines = {touch(value(params, "K"), value(params, "Z"), true)};
  problem.network.state_links = {{0, 1, 0, 0.04}};
  return problem;
}

std::vector<ReferenceProblem> reference_problems() {
  std::vector<ReferenceProblem> all;
  const nlohmann::json oscillators = reference("R01_damped_oscillator");
  for (const auto& entry : oscillators["cases"]) all.push_back(damped_oscillator(entry["name"]));
  for (const auto& make :
       {chain_mode, membrane_mode, plucked_string, two_bodies, duffing, stiff_fpu, quadratic_chain,
        dimer, bounce, hertz, bouncing_ball, stick_slip, standard_linear_solid, rupture, pendulum,
        collision, cluster}) {
    all.push_back(make());
  }
  return all;
}

}  // namespace cordis::test::convergence
