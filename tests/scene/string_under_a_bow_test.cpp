// tests/scene/string_under_a_bow_test.cpp -- a string under Coulomb friction, as a scene writes it.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"
#include "tests/support/filled.h"
#include "tests/support/reference_data.h"
#include "tests/support/rounds.h"

namespace cordis::scene {
namespace {

using test::number;

constexpr std::uint32_t kBead = 20;  // the MAT between two strings of 10

/// A light string across the way of a bow, with a bead that is pressed on the bow. Its links have no rest length, so
/// they pull the bead back by k times its way, in each direction.
Scene bowed_bead(const nlohmann::json& params) {
  constexpr double kPress = 10.0;  // [N]
  config::Problems problems;
  Scene scene = load_scene_text(
      test::filled(
          R"YAML(cordis: 1
name: bowed_bead
space: 3
step: {rate_hz: 50000}
liaisons:
  hair:
    stiffness_n_per_m: 1.0e+5
    viscosity_n_s_per_m: 100
    pulls: false
    friction: {static: <static>, kinetic: <kinetic>, stiffness_n_per_m: 1.0e+6, viscosity_n_s_per_m: 300}
  spring: {kind: spring_damper, stiffness_n_per_m: <spring>, viscosity_n_s_per_m: 0.001}
matter:
  left: {kind: string, count: 10, from_m: [0, 0.0499, -2], to_m: [0, 0.0499, -0.2], ends: first_fixed, mass_kg: 0.00002, stiffness_n_per_m: <spring>, viscosity_n_s_per_m: 0.001, rest_m: 0}
  right: {kind: string, count: 10, from_m: [0, 0.0499, 2], to_m: [0, 0.0499, 0.2], ends: first_fixed, mass_kg: 0.00002, stiffness_n_per_m: <spring>, viscosity_n_s_per_m: 0.001, rest_m: 0}
  bead: {kind: mass, ball: {mass_kg: <mass>, radius_m: 0.05}, at_m: [0, 0.0499, 0], velocity_m_per_s: [<speed>, 0, 0], driven: {force_n: [0, -10, 0]}}
  bow: {kind: plane, at_m: [0, 0, 0], normal: y, driven: {displacement_m: ["<speed> * time_s", 0, 0]}}
links:
  - {liaison: spring, between: ["left[9]", bead], rest_m: 0}
  - {liaison: spring, between: ["right[9]", bead], rest_m: 0}
  - {liaison: hair, between_sets: [bead, bow], rest: radii, range_m: 0.051}
)YAML",
          {{"static", std::to_string(number(params["Fs"]) / kPress)},
           {"kinetic", std::to_string(number(params["Fk"]) / kPress)},
           {"spring", std::to_string(5.0 * number(params["k"]))},  // 10 in a row, on two sides
           {"mass", params["m"].get<std::string>()},
           {"speed", params["V"].get<std::string>()}}),
      "bowed_bead", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

void expect_stick_and_slip(const nlohmann::json& params, const nlohmann::json& expected) {
  const Scene scene = bowed_bead(params);
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  const double period = number(expected["period"]);
  const double speed = number(params["V"]);
  const double kSlow = 0.06 * speed;  // below it a slip is not seen [m/s]
  std::vector<double> began;
  std::vector<double> lasted;
  std::vector<double> taken;
  double furthest = -1.0;
  double nearest = 1.0;
  bool slips = false;
  for (double time = 0.0; time < 6.5 * period;) {
    world.step();
    time = static_cast<double>(world.step_count()) * scene.network.step;
    const bool slips_now = speed - world.velocity(kBead).x() > kSlow;
    if (slips_now && !slips) {
      began.push_back(time);
      taken.push_back(world.energy().dissipated);
    }
    if (!slips_now && slips) lasted.push_back(time - began.back());
    slips = slips_now;
    if (began.empty()) continue;
    furthest = std::max(furthest, world.position(kBead).x());
    nearest = std::min(nearest, world.position(kBead).x());
  }

  ASSERT_GE(began.size(), 5U);
  const double fs = number(params["Fs"]);
  const double fk = number(params["Fk"]);
  const double unseen = 2.0 * kSlow * number(params["m"]) / (fs - fk);
  const double give = fs / 1e6;  // of the contact [m]
  const double work = number(expected["dissipated_per_period_equals_belt_work"]);
  for (std::size_t n = 2; n < began.size(); ++n) {
    EXPECT_NEAR(began[n] - began[n - 1], period, 2e-3 * period);
    EXPECT_NEAR(lasted[n - 1] + unseen, number(expected["t_slip"]), 2e-3 * period);
    EXPECT_NEAR(taken[n] - taken[n - 1], work, 3e-3 * work);
  }
  const double reach = number(expected["x_max"]) - number(expected["x_min"]);
  EXPECT_NEAR(furthest, number(expected["x_max"]), 4.0 * give + 2e-3 * reach);
  EXPECT_NEAR(nearest, number(expected["x_min"]), 4.0 * give + 2e-3 * reach);
}

TEST(StringUnderABow, SticksAndSlipsByTheClosedForm) {
  const nlohmann::json& data = test::reference("R15_stick_slip_coulomb");
  expect_stick_and_slip(data["params"], data);
  expect_stick_and_slip(data["second_case"]["params"], data["second_case"]);
}

}  // namespace
}  // namespace cordis::scene
