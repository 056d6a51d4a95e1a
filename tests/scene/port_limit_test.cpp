#include "sim_node/scene/port_limit.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

struct Row {
  double beta;  // b T / m
  double z;     // B T / m
  int delay;
  double stable;   // K T^2 / m
  double passive;  // K T^2 / m
};

std::vector<Row> reference_rows() {
  std::ifstream file(CORDIS_REFERENCE_DIR "/R20_haptic_boundaries.csv");
  std::string line;
  std::getline(file, line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    Row row{};
    char comma = 0;
    cells >> row.beta >> comma >> row.z >> comma >> row.delay >> comma >> row.stable >> comma >>
        row.passive;
    rows.push_back(row);
  }
  return rows;
}

TEST(PortLimit, MeetsTheReferenceTableOfStability) {
  const double mass = 0.05;
  const double period = 0.001;
  const std::vector<Row> rows = reference_rows();
  ASSERT_EQ(rows.size(), 252u);
  for (const Row& row : rows) {
    const PortLoop loop{mass, row.beta * mass / period, period, row.delay};
    const double stiffness = stable_stiffness(loop, row.z * mass / period) * period * period / mass;
    // The table has ten digits of a bisection.
    EXPECT_NEAR(stiffness, row.stable, 1e-6 * row.stable + 1e-8)
        << row.beta << " " << row.z << " " << row.delay;
  }
}

TEST(PortLimit, MeetsTheReferenceTableOfPassivity) {
  const double mass = 0.05;
  const double period = 0.001;
  for (const Row& row : reference_rows()) {
    const PortLoop loop{mass, row.beta * mass / period, period, row.delay};
    const double stiffness =
        passive_stiffness(loop, row.z * mass / period) * period * period / mass;
    // The least is found on a grid of theta: to second order in its width, pi / 4000.
    EXPECT_NEAR(stiffness, row.passive, 1e-4 * row.passive + 1e-6)
        << row.beta << " " << row.z << " " << row.delay;
  }
}

Scene wall_of(const std::string& stiffness) {
  return scene_with_bob(1, "  ground: {kind: fixed, at_m: 0}\n",
                        "liaisons:\n  wall: {kind: spring, stiffness_n_per_m: " + stiffness +
                            "}\nports:\n  key: {device: keyboard, axes: 0, role: mass, at_m: 0, "
                            "coupling: direct}\n"
                            "links:\n  - {liaison: wall, between: [key, ground]}\n"
                            "  - {liaison: wall, between: [key, bob]}\n");
}

config::DeviceLimits key_limits() {
  config::DeviceLimits limits;
  limits.moving_mass_kg = 0.3;
  limits.viscosity_n_s_per_m = 1.5;
  return limits;
}

TEST(PortLimit, RefusesASceneStifferThanItsPortWithTheNumberItMayHave) {
  const Scene soft = wall_of("500");  // two of them: 1000 N/m; the limit is 1001 N/m
  const Scene stiff = wall_of("501");

  EXPECT_EQ(refusal_of(soft, soft.ports[0], key_limits(), 1), "");
  const std::string refusal = refusal_of(stiff, stiff.ports[0], key_limits(), 1);
  EXPECT_NE(refusal.find("as stiff as 1002 N/m"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("can bear 1001 N/m"), std::string::npos) << refusal;
  EXPECT_EQ(refusal_of(stiff, stiff.ports[0], key_limits(), 0), "") << "3003 N/m without delay";
}

TEST(PortLimit, KnowsNothingOfADeviceThatDeclaresNothing) {
  const Scene scene = wall_of("1e6");

  EXPECT_EQ(refusal_of(scene, scene.ports[0], config::DeviceLimits{}, 1), "");
}

TEST(PortLimit, TakesADeclaredLimitAtItsWord) {
  const Scene scene = wall_of("100");
  config::DeviceLimits limits = key_limits();
  limits.stiffness_limit_n_per_m = 150.0;

  EXPECT_NE(refusal_of(scene, scene.ports[0], limits, 0).find("can bear 150 N/m"),
            std::string::npos);
}

}  // namespace
}  // namespace cordis::scene
