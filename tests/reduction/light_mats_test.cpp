#include <cmath>
#include <numbers>

#include "tests/reduction/scenes.h"

namespace cordis::plan {
namespace {

/// A bob on a row of links in 1 dimension, with a MAT of this mass between each two.
std::string row_text(const std::string& mass, const std::string& links, double rate_hz,
                     const std::string& head = "reduce: [series, massless]\n") {
  return "cordis: 1\nspace: 1\nstep: {rate_hz: " + std::to_string(rate_hz) + "}\n" + head +
         "liaisons:\n"
         "  soft: {kind: spring, stiffness_n_per_m: 60}\n"
         "  hard: {kind: spring, stiffness_n_per_m: 120}\n"
         "  oil: {kind: damper, viscosity_n_s_per_m: 0.8}\n"
         "matter:\n"
         "  wall: {kind: fixed, at_m: 0}\n"
         "  joint: {kind: mass, mass_kg: " +
         mass +
         ", at_m: [0, 0]}\n"
         "  bob: {kind: mass, mass_kg: 0.1, at_m: 0, velocity_m_per_s: 0.5}\n"
         "links:\n" +
         links;
}

const std::string kSprings =
    "  - {liaison: soft, between: [wall, \"joint[0]\"], rest_m: 0}\n"
    "  - {liaison: hard, between: [\"joint[1]\", \"joint[0]\"], rest_m: 0}\n"
    "  - {liaison: hard, between: [\"joint[1]\", bob], rest_m: 0}\n";
const std::string kSpringsAndOil =
    "  - {liaison: soft, between: [wall, \"joint[0]\"], rest_m: 0}\n"
    "  - {liaison: oil, between: [\"joint[0]\", \"joint[1]\"]}\n"
    "  - {liaison: hard, between: [\"joint[1]\", bob], rest_m: 0}\n";

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
                       "  - {liaison: soft, between: [\"joint[0]\", wall], rest_m: -0.1}\n"
                       "  - {liaison: hard, between: [\"joint[0]\", \"joint[1]\"], rest_m: 0.2}\n"
                       "  - {liaison: hard, between: [bob, \"joint[1]\"], rest_m: 0.05}\n",
                       1000));

  ASSERT_EQ(scene.network.links.size(), 1u);
  const engine::Link& link = scene.network.links[0];
  const double from_the_wall = link.mat_a == 0 ? link.rest_length : -link.rest_length;
  EXPECT_NEAR(from_the_wall, 0.1 + 0.2 - 0.05, 1e-15);
}

TEST(Series, DampersInARowAreOneOfTheirFluidities) {
  const scene::Scene scene = reduced(
      row_text("0",
               "  - {liaison: oil, between: [wall, \"joint[0]\"]}\n"
               "  - {liaison: oil, between: [\"joint[0]\", \"joint[1]\"]}\n"
               "  - {liaison: oil, viscosity_n_s_per_m: 0.4, between: [\"joint[1]\", bob]}\n",
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

TEST(Massless, ASpringAndADamperInARowAreAMaxwellElement) {
  const scene::Scene scene = reduced(row_text("0", kSpringsAndOil, 1000));

  EXPECT_TRUE(scene.network.links.empty());
  ASSERT_EQ(scene.network.maxwell_links.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.network.maxwell_links[0].stiffness, 40.0);  // 1/60 + 1/120
  EXPECT_DOUBLE_EQ(scene.network.maxwell_links[0].viscosity, 0.8);
  const double heavy = difference_to_joints_of(1e-3, kSpringsAndOil);
  const double light = difference_to_joints_of(1e-4, kSpringsAndOil);
  EXPECT_LT(light, 4e-3);
  EXPECT_GT(heavy / light, 8.0);
}

TEST(Massless, AMatThatNothingTakesOutIsAnError) {
  const std::string text = row_text("0", kSprings, 1000, "");
  EXPECT_NE(refusal_of(text).find("'mass_kg' in matter 'joint' must be > 0, got 0"),
            std::string::npos)
      << refusal_of(text);
  const std::string three = refusal_of(
      row_text("0", kSprings + "  - {liaison: oil, between: [\"joint[0]\", wall]}\n", 1000));
  EXPECT_NE(three.find("joint must be > 0: no reduction takes it out, for it has 3 links"),
            std::string::npos)
      << three;
  const std::string drawn =
      refusal_of(row_text("0",
                          "  - {liaison: soft, between: [wall, \"joint[0]\"], rest_m: 0.1}\n"
                          "  - {liaison: oil, between: [\"joint[0]\", bob]}\n"
                          "  - {liaison: hard, between: [\"joint[1]\", bob], rest_m: 0}\n",
                          1000));
  EXPECT_NE(drawn.find("the spring beside it is drawn or pushed at the start"), std::string::npos)
      << drawn;
}

TEST(Massless, AMatInAMediumOrOnALoopIsAnError) {
  const std::string in_medium = refusal_of(row_text(
      "0", kSprings, 1000, "reduce: [series, massless]\nworld: {viscosity_n_s_per_m: 0.1}\n"));
  EXPECT_NE(in_medium.find("the medium acts on it"), std::string::npos) << in_medium;
  const std::string loop =
      refusal_of(row_text("0",
                          "  - {liaison: soft, between: [wall, \"joint[0]\"], rest_m: 0}\n"
                          "  - {liaison: hard, between: [wall, \"joint[0]\"], rest_m: 0}\n"
                          "  - {liaison: hard, between: [wall, \"joint[1]\"], rest_m: 0}\n"
                          "  - {liaison: hard, between: [\"joint[1]\", bob], rest_m: 0}\n",
                          1000));
  EXPECT_NE(loop.find("both its links lead to the same MAT"), std::string::npos) << loop;
}

TEST(Massless, AMatOfASignalIsAnError) {
  const std::string told = refusal_of(
      row_text("0", kSprings + "signals:\n  at: {of: \"joint[0]\", quantity: position}\n", 1000));
  EXPECT_NE(told.find("for a port, a signal, a set"), std::string::npos) << told;
}

TEST(Series, InThePlaneAPushedRowIsRefusedAndOneAtRestWatched) {
  const auto text = [](double x) {
    return "cordis: 1\nspace: 2\nstep: {rate_hz: 1000}\nreduce: all\n"
           "liaisons: {s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0.1}}\n"
           "matter:\n"
           "  wall: {kind: fixed, at_m: [0, 0]}\n"
           "  joint: {kind: mass, mass_kg: 0, at_m: [0.1, 0]}\n"
           "  bob: {kind: mass, mass_kg: 0.1, at_m: [" +
           std::to_string(x) +
           ", 0]}\n"
           "links:\n"
           "  - {liaison: s, between: [wall, joint]}\n"
           "  - {liaison: s, between: [joint, bob]}\n";
  };
  EXPECT_NE(refusal_of(text(0.19)).find("its springs are pushed at the start"), std::string::npos);

  const scene::Scene at_rest = reduced(text(0.2));
  EXPECT_EQ(at_rest.struts.size(), 1u);
  ASSERT_EQ(at_rest.reductions.size(), 1u);
  ASSERT_EQ(at_rest.reductions[0].doubts.size(), 1u);
  EXPECT_NE(at_rest.reductions[0].doubts[0].find("1 begins at rest"), std::string::npos);

  const scene::Scene drawn = reduced(text(0.21));
  EXPECT_EQ(drawn.struts.size(), 1u);
  ASSERT_EQ(drawn.reductions.size(), 1u);
  ASSERT_EQ(drawn.reductions[0].doubts.size(), 1u);  // it may be pushed later
  EXPECT_EQ(drawn.reductions[0].doubts[0].find("at rest"), std::string::npos);
}

TEST(Series, InThePlaneARowStaysApartFromASpringBesideIt) {
  const auto text = [](const std::string& beside) {
    return "cordis: 1\nspace: 2\nstep: {rate_hz: 1000}\nreduce: all\n"
           "liaisons:\n"
           "  s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0.1}\n"
           "  oil: {kind: damper, viscosity_n_s_per_m: 0.1}\n"
           "matter:\n"
           "  wall: {kind: fixed, at_m: [0, 0]}\n"
           "  joint: {kind: mass, mass_kg: 0, at_m: [0.12, 0]}\n"
           "  bob: {kind: mass, mass_kg: 0.1, at_m: [0.24, 0.01]}\n"
           "links:\n"
           "  - {liaison: s, between: [wall, joint]}\n"
           "  - {liaison: s, between: [joint, bob]}\n"
           "  - {liaison: " +
           beside + ", between: [wall, bob]}\n";
  };
  const scene::Scene spring = reduced(text("s"));
  ASSERT_EQ(spring.network.links.size(), 2u) << "its rest length tells when it is pushed";
  ASSERT_EQ(spring.struts.size(), 1u);
  EXPECT_EQ(spring.network.links[spring.struts[0]].rest_length, 0.2);
  const scene::Scene damper = reduced(text("oil"));
  EXPECT_EQ(damper.network.links.size(), 1u);
  EXPECT_EQ(damper.struts.size(), 1u);
}

/// A string of 20 bobs in 1 dimension with a MAT of this mass between each two, struck.
std::string string_with_light_joints(const std::string& head, double rate_hz) {
  std::string text = "cordis: 1\nspace: 1\nstep: {rate_hz: " + std::to_string(rate_hz) + "}\n" +
                     head +
                     "liaisons: {s: {kind: spring, stiffness_n_per_m: 2000, rest_m: 0}}\n"
                     "matter:\n  wall: {kind: fixed, at_m: [0, 0]}\n"
                     "  bob: {kind: mass, mass_kg: 0.01, at_m: [0";
  for (int i = 1; i < 20; ++i) text += ", 0";
  text +=
      "]}\n  hammer: {kind: mass, mass_kg: 0.02, at_m: 0, velocity_m_per_s: 1}\n"
      "  light: {kind: mass, mass_kg: 1.0e-4, at_m: [0";
  for (int i = 1; i < 19; ++i) text += ", 0";
  text +=
      "]}\nlinks:\n"
      "  - {liaison: s, between: [\"wall[0]\", \"bob[0]\"]}\n"
      "  - {liaison: s, between: [\"wall[1]\", \"bob[19]\"]}\n"
      "  - {liaison: s, between: [hammer, \"bob[6]\"]}\n"
      "  - {liaison: s, between: [\"bob[0..18]\", light]}\n"
      "  - {liaison: s, between: [light, \"bob[1..19]\"]}\n";
  return text;
}

TEST(Massless, LightMatsGoWithinTheToleranceAndTheErrorIsWithinTheBudget) {
  // w0 = sqrt(4000 / 1e-4) = 6325 /s; at the fastest vibration of the rest, 2 sqrt(1000 / 0.01)
  // = 632 /s, (w / w0)^2 = 1e-2
  const std::string head = "accuracy: {tolerance: 0.05, band_hz: 100, over_s: 0}\n";
  const std::string text = string_with_light_joints(head, 200000);
  const scene::Scene scene = reduced(text);

  EXPECT_EQ(scene.network.mats.size(), 23u);
  ASSERT_EQ(scene.reductions.size(), 1u);
  const double w = 2.0 * std::numbers::pi * 100.0;
  EXPECT_NEAR(scene.reductions[0].budget, w * w * 1e-4 / 4000.0, 1e-9);
  EXPECT_NEAR(wish_of(scene).tolerance, 0.05 - scene.reductions[0].budget, 1e-15);
  double mass = 0.0;
  double mass_before = 0.0;
  for (const engine::Mat& mat : scene.network.mats) mass += mat.mass;
  for (const engine::Mat& mat : loaded(text).network.mats) mass_before += mat.mass;
  EXPECT_NEAR(mass, mass_before, 1e-12);

  // A phase error of w t times the pitch error, which is half of the budget.
  constexpr int kSteps = 10000;  // 0.05 s
  const auto before = motion(loaded(text), "bob", kSteps);
  const auto after = motion(scene, "bob", kSteps);
  const double error = largest_difference(before, after) / largest_distance(before);
  EXPECT_LT(error, 0.5 * scene.reductions[0].budget * w * 0.05);
  EXPECT_GT(error, 1e-5);
}

constexpr double kTenHertz = 2.0 * std::numbers::pi * 10.0;  // [rad/s]

/// Two bobs with light joints between them, judged at 10 Hz.
std::string bobs_text(int space, const std::string& joints, const std::string& links,
                      double tolerance = 0.04) {
  return "cordis: 1\nspace: " + std::to_string(space) +
         "\nstep: {rate_hz: 100000}\naccuracy: {tolerance: " + std::to_string(tolerance) +
         ", band_hz: 10, over_s: 0}\n"
         "liaisons:\n"
         "  soft: {kind: spring, stiffness_n_per_m: 60}\n"
         "  hard: {kind: spring, stiffness_n_per_m: 120}\n"
         "  oil: {kind: damper, viscosity_n_s_per_m: 0.8}\n"
         "matter:\n"
         "  bob: {kind: points, mass_kg: 0.1, at_m: " +
         std::string(space == 1 ? "[0, 1]" : "[[0, 0], [1, 0]]") + "}\n" + joints + "links:\n" +
         links;
}

const std::string kSoftAndHard =
    "  - {liaison: soft, between: [\"bob[0]\", joint], rest_m: 0}\n"
    "  - {liaison: hard, between: [joint, \"bob[1]\"], rest_m: 0}\n";

TEST(Light, TheMassGoesToTheNeighboursAsTheForceDoes) {
  // At 2/3 the pulls of 60 and 120 N/m on it are the same.
  const scene::Scene scene = reduced(bobs_text(
      1, "  joint: {kind: mass, mass_kg: 0.0003, at_m: 0.66666666666666667}\n", kSoftAndHard));
  ASSERT_EQ(scene.network.mats.size(), 2u);
  EXPECT_NEAR(scene.network.mats[0].mass, 0.1 + 0.0001, 1e-12);
  EXPECT_NEAR(scene.network.mats[1].mass, 0.1 + 0.0002, 1e-12);
}

TEST(Light, BetweenSpringAndDamperTheMassGoesToTheSpring) {
  for (const bool spring_first : {true, false}) {
    const std::string at = spring_first ? "0" : "1";
    const std::string spring =
        "  - {liaison: soft, between: [\"bob[" + at + "]\", joint], rest_m: 0}\n";
    const std::string oil = "  - {liaison: oil, between: [joint, \"bob[" +
                            std::string(spring_first ? "1" : "0") + "]\"]}\n";
    const scene::Scene scene =
        reduced(bobs_text(1, "  joint: {kind: mass, mass_kg: 0.00005, at_m: " + at + "}\n",
                          spring_first ? spring + oil : oil + spring));
    ASSERT_EQ(scene.network.maxwell_links.size(), 1u);
    EXPECT_NEAR(scene.network.mats[spring_first ? 0 : 1].mass, 0.10005, 1e-12);
    EXPECT_EQ(scene.network.mats[spring_first ? 1 : 0].mass, 0.1);
    ASSERT_EQ(scene.reductions.size(), 1u);
    EXPECT_NEAR(scene.reductions[0].budget, 2.0 * kTenHertz * kTenHertz * 0.00005 / 60.0, 1e-9);
  }
}

TEST(Light, StaysWhereItDoesNotBeginAsItsLinksHoldIt) {
  const auto mats_with = [](const std::string& how) {
    return reduced(
               bobs_text(1, "  joint: {kind: mass, mass_kg: 0.0003, " + how + "}\n", kSoftAndHard))
        .network.mats.size();
  };
  const std::string balanced = "at_m: 0.66666666666666667";
  EXPECT_EQ(mats_with(balanced), 2u);
  EXPECT_EQ(mats_with("at_m: 0.6"), 3u);
  EXPECT_EQ(mats_with(balanced + ", velocity_m_per_s: 0.1"), 3u);
}

TEST(Light, ErrorsOfARowAddUp) {
  const std::string joints =
      "  joint: {kind: points, mass_kg: 0.0003, at_m: [0.4, 0.8]}\n";  // 60 : 60 : 120 N/m
  const std::string links =
      "  - {liaison: soft, between: [\"bob[0]\", \"joint[0]\"], rest_m: 0}\n"
      "  - {liaison: soft, between: [\"joint[0]\", \"joint[1]\"], rest_m: 0}\n"
      "  - {liaison: hard, between: [\"joint[1]\", \"bob[1]\"], rest_m: 0}\n";
  const double first = kTenHertz * kTenHertz * 0.0003 / 120.0;
  const double second = kTenHertz * kTenHertz * 0.00045 / 150.0;  // half of the first joint on it

  const scene::Scene both = reduced(bobs_text(1, joints, links, 4.2 * (first + second)));
  EXPECT_EQ(both.network.mats.size(), 2u);
  EXPECT_NEAR(both.reductions.at(0).budget, first + second, 1e-9);
  const scene::Scene one = reduced(bobs_text(1, joints, links, 3.8 * (first + second)));
  EXPECT_EQ(one.network.mats.size(), 3u);
  EXPECT_NEAR(one.reductions.at(0).budget, first, 1e-9);
}

TEST(Light, InThePlaneItIsJudgedAcrossTheDrawnSprings) {
  const auto scene_with = [](double rest) {
    const std::string rest_text = ", rest_m: " + std::to_string(rest) + "}\n";
    return reduced(bobs_text(2, "  joint: {kind: mass, mass_kg: 0.0003, at_m: [0.5, 0]}\n",
                             "  - {liaison: soft, between: [\"bob[0]\", joint]" + rest_text +
                                 "  - {liaison: soft, between: [joint, \"bob[1]\"]" + rest_text,
                             0.2));
  };
  const scene::Scene drawn = scene_with(0.25);
  ASSERT_EQ(drawn.network.mats.size(), 2u);
  const double tension = 60.0 * 0.25;
  EXPECT_NEAR(drawn.reductions.at(0).budget, kTenHertz * kTenHertz * 0.0003 / (tension * 4.0),
              1e-9);
  EXPECT_EQ(scene_with(0.5).network.mats.size(), 3u) << "nothing holds it across";
}

TEST(Massless, MatsStayThatAreTooHeavyForTheTolerance) {
  const std::string head = "accuracy: {tolerance: 0.03, band_hz: 100, over_s: 0}\n";
  EXPECT_EQ(reduced(string_with_light_joints(head, 20000)).network.mats.size(), 42u);
  EXPECT_EQ(reduced(string_with_light_joints("reduce: all\n", 20000)).network.mats.size(), 42u);
}

}  // namespace
}  // namespace cordis::plan
