// tests/reduction/series_test.cpp
#include "tests/reduction/scenes.h"
#include "tests/support/filled.h"

namespace cordis::plan {
namespace {

/// A bob on a row of links in 1 dimension, with a MAT of this mass between each two.
std::string row_text(const std::string& mass, const std::string& links, double rate_hz,
                     const std::string& head = "reduce: [series]\n") {
  return test::filled(R"(cordis: 1
space: 1
step: {rate_hz: <rate_hz>}
)",
                      {{"rate_hz", std::to_string(rate_hz)}}) +
         head +
         test::filled(R"(liaisons:
  soft: {kind: spring, stiffness_n_per_m: 60}
  hard: {kind: spring, stiffness_n_per_m: 120}
  oil: {kind: damper, viscosity_n_s_per_m: 0.8}
matter:
  wall: {kind: fixed, at_m: 0}
  joint: {kind: mass, mass_kg: <mass>, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0, velocity_m_per_s: 0.5}
links:
)",
                      {{"mass", mass}}) +
         links;
}

const std::string kSprings =
    R"(  - {liaison: soft, between: [wall, "joint[0]"], rest_m: 0}
  - {liaison: hard, between: ["joint[1]", "joint[0]"], rest_m: 0}
  - {liaison: hard, between: ["joint[1]", bob], rest_m: 0}
)";

TEST(Series, SpringsInARowAreOneOfTheirCompliances) {
  const scene::Scene scene = reduced(row_text("0", kSprings, 1000));

  ASSERT_EQ(scene.network.links.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.network.links[0].stiffness, 30.0);  // 1/60 + 1/120 + 1/120
  ASSERT_EQ(scene.network.mats.size(), 2u);
  EXPECT_EQ(matter(scene, "bob").first, 1u);
  ASSERT_EQ(scene.reductions.size(), 1u);
  EXPECT_EQ(scene.reductions[0].name, "series");
  EXPECT_EQ(scene.reductions[0].count, 2u);
}

TEST(Series, RestLengthsAddUpWhicheverWayTheLinksAreWritten) {
  const scene::Scene scene =
      reduced(row_text("0",
                       R"(  - {liaison: soft, between: ["joint[0]", wall], rest_m: -0.1}
  - {liaison: hard, between: ["joint[0]", "joint[1]"], rest_m: 0.2}
  - {liaison: hard, between: [bob, "joint[1]"], rest_m: 0.05}
)",
                       1000));

  ASSERT_EQ(scene.network.links.size(), 1u);
  const engine::Link& link = scene.network.links[0];
  const double from_the_wall = link.mat_a == 0 ? link.rest_length : -link.rest_length;
  EXPECT_NEAR(from_the_wall, 0.1 + 0.2 - 0.05, 1e-15);
}

TEST(Series, DampersInARowAreOneOfTheirFluidities) {
  const scene::Scene scene = reduced(row_text("0",
                                              R"(  - {liaison: oil, between: [wall, "joint[0]"]}
  - {liaison: oil, between: ["joint[0]", "joint[1]"]}
  - {liaison: oil, viscosity_n_s_per_m: 0.4, between: ["joint[1]", bob]}
)",
                                              1000));

  ASSERT_EQ(scene.network.links.size(), 1u);
  EXPECT_EQ(scene.network.links[0].stiffness, 0.0);
  EXPECT_DOUBLE_EQ(scene.network.links[0].viscosity, 0.2);  // 1/0.8 + 1/0.8 + 1/0.4
}

/// The largest difference between a row with light joints, taken by small steps, and one without.
double difference_to_joints_of(double mass, const std::string& links) {
  constexpr double kRate = 32000.0;
  const auto without = motion(reduced(row_text("0", links, kRate)), "bob", 8000);
  const auto with = motion(loaded(row_text(std::to_string(mass), links, kRate)), "bob", 8000);
  EXPECT_GT(largest_distance(without), 0.02);
  return largest_difference(with, without) / largest_distance(without);
}

TEST(Series, IsWhatTheRowTendsToAsItsMatsGetLighter) {
  // (w / w0)^2 is 1.7e-3 and 1.7e-4 here, w t is 4.3
  const double heavy = difference_to_joints_of(1e-3, kSprings);
  const double light = difference_to_joints_of(1e-4, kSprings);

  EXPECT_LT(light, 4e-3);
  EXPECT_NEAR(heavy / light, 10.0, 2.0);
}

TEST(Series, AMatThatNothingTakesOutIsAnError) {
  const std::string text = row_text("0", kSprings, 1000, "");
  EXPECT_NE(refusal_of(text).find("'mass_kg' in matter 'joint' must be > 0, got 0"),
            std::string::npos)
      << refusal_of(text);
  const std::string three = refusal_of(
      row_text("0", kSprings + "  - {liaison: oil, between: [\"joint[0]\", wall]}\n", 1000));
  EXPECT_NE(three.find("joint must be > 0: no reduction takes it out, for it has 3 links"),
            std::string::npos)
      << three;
  const std::string unlike =
      refusal_of(row_text("0",
                          R"(  - {liaison: soft, between: [wall, "joint[0]"], rest_m: 0}
  - {liaison: oil, between: ["joint[0]", "joint[1]"]}
  - {liaison: hard, between: ["joint[1]", bob], rest_m: 0}
)",
                          1000));
  EXPECT_NE(unlike.find("its two links are not of one kind"), std::string::npos) << unlike;
}

TEST(Series, AMatInAMediumOrOnALoopIsAnError) {
  const std::string in_medium = refusal_of(
      row_text("0", kSprings, 1000, "reduce: [series]\nworld: {viscosity_n_s_per_m: 0.1}\n"));
  EXPECT_NE(in_medium.find("the medium acts on it"), std::string::npos) << in_medium;
  const std::string loop =
      refusal_of(row_text("0",
                          R"(  - {liaison: soft, between: [wall, "joint[0]"], rest_m: 0}
  - {liaison: hard, between: [wall, "joint[0]"], rest_m: 0}
  - {liaison: hard, between: [wall, "joint[1]"], rest_m: 0}
  - {liaison: hard, between: ["joint[1]", bob], rest_m: 0}
)",
                          1000));
  EXPECT_NE(loop.find("both its links lead to the same MAT"), std::string::npos) << loop;
}

TEST(Series, AMatOfASignalIsAnError) {
  const std::string report = refusal_of(
      row_text("0", kSprings + "signals:\n  at: {of: \"joint[0]\", quantity: position}\n", 1000));
  EXPECT_NE(report.find("for a port, a signal, a set"), std::string::npos) << report;
}

TEST(Series, AMatOfAConditionIsAnError) {
  const std::string latch = "  - {liaison: latch, between: [wall, bob]}\n";
  const std::string report =
      refusal_of(with_latch(row_text("0", kSprings + latch, 1000), "joint[0].position_m > 0.1"));
  EXPECT_NE(report.find("or a link with states asks for it"), std::string::npos) << report;
}

/// A row of springs without rest length along the x axis of a plane, with gravity across it or not.
std::string row_in_a_plane(const std::string& gravity) {
  return R"(cordis: 1
space: 2
step: {rate_hz: 1000}
reduce: all
world: {gravity_m_per_s2: )" +
         gravity +
         R"(}
liaisons: {s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0}}
matter:
  wall: {kind: fixed, at_m: [0, 0]}
  joint: {kind: mass, mass_kg: 0, at_m: [0.1, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.3, 0]}
links:
  - {liaison: s, between: [wall, joint]}
  - {liaison: s, between: [joint, bob]}
)";
}

TEST(Series, ARowInAPlaneGoesOnlyWhereItsLineIsComputedIn1D) {
  const scene::Scene line = reduced(row_in_a_plane("[1, 0]"));
  EXPECT_EQ(line.space(), 1);
  ASSERT_EQ(line.network.links.size(), 1u);
  EXPECT_DOUBLE_EQ(line.network.links[0].stiffness, 50.0);
  ASSERT_EQ(line.reductions.size(), 2u);
  EXPECT_EQ(line.reductions[0].name, "dimension");

  const std::string plane = refusal_of(row_in_a_plane("[1, 1]"));
  EXPECT_NE(plane.find("the mass of joint must be > 0: no reduction takes it out, for in 2 "
                       "dimensions it gives way sideways when its row is pushed"),
            std::string::npos)
      << plane;
}

}  // namespace
}  // namespace cordis::plan
