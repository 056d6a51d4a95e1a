// tests/reduction/parallel_test.cpp
#include "tests/reduction/scenes.h"

namespace cordis::plan {
namespace {

/// A mass on three linear links to a wall, one of them from the other side.
std::string on_three_links(int space, const std::string& signals = {}) {
  const std::string place = space == 1 ? "0.12" : "[0.12, 0.05]";
  const std::string wall = space == 1 ? "0" : "[0, 0]";
  return "cordis: 1\nspace: " + std::to_string(space) +
         R"(
step: {rate_hz: 1000}
reduce: [parallel]
liaisons:
  a: {kind: spring, stiffness_n_per_m: 30, rest_m: 0.1}
  b: {kind: spring_damper, stiffness_n_per_m: 10, viscosity_n_s_per_m: 0.02, rest_m: )" +
         (space == 1 ? "-0.2" : "0.2") +
         R"(}
  c: {kind: damper, viscosity_n_s_per_m: 0.03}
matter:
  wall: {kind: fixed, at_m: )" +
         wall + "}\n  bob: {kind: mass, mass_kg: 0.1, at_m: " + place +
         R"(}
links:
  - {liaison: a, between: [wall, bob], name: first}
  - {liaison: b, between: [bob, wall], name: second}
  - {liaison: c, between: [wall, bob], name: third}
)" + signals;
}

TEST(Parallel, LinksBetweenTheSameTwoMatsBecomeOne) {
  const scene::Scene scene = reduced(on_three_links(1));

  ASSERT_EQ(scene.network.links.size(), 1u);
  const engine::Link& link = scene.network.links[0];
  EXPECT_DOUBLE_EQ(link.stiffness, 40.0);
  EXPECT_DOUBLE_EQ(link.viscosity, 0.05);
  EXPECT_DOUBLE_EQ(link.rest_length, (30 * 0.1 + 10 * 0.2) / 40);  // from the wall to the bob
  ASSERT_EQ(scene.reductions.size(), 1u);
  EXPECT_EQ(scene.reductions[0].name, "parallel");
  EXPECT_EQ(scene.reductions[0].count, 2u);
  ASSERT_EQ(scene.links.size(), 1u);
  EXPECT_EQ(scene.links[0].name, "first");
}

TEST(Parallel, MoveAsTheyDidApart) {
  for (const int space : {1, 2}) {
    const std::string text = on_three_links(space);
    const auto apart = motion(loaded(text), "bob", 500);
    const auto merged = motion(reduced(text), "bob", 500);

    EXPECT_GT(largest_distance(apart), 0.005);
    EXPECT_LT(largest_difference(apart, merged), 1e-13) << space;  // rounding
  }
}

TEST(Parallel, ALinkOfASignalStays) {
  const scene::Scene scene =
      reduced(on_three_links(1, "signals:\n  tension: {of: second, quantity: force}\n"));

  ASSERT_EQ(scene.network.links.size(), 2u);
  const scene::Signal& signal = scene.signals.signals()[0];
  EXPECT_EQ(scene.network.links[signal.index].stiffness, 10.0);
  EXPECT_EQ(scene.network.links[1 - signal.index].viscosity, 0.03);
}

TEST(Parallel, ALinkOfAConditionStays) {
  const scene::Scene scene = reduced(with_latch(
      on_three_links(1, "  - {liaison: latch, between: [wall, bob]}\n"), "second.force_n > 1"));

  ASSERT_EQ(scene.network.links.size(), 2u);
  ASSERT_EQ(scene.network.variables.size(), 1u);
  EXPECT_EQ(scene.network.links[scene.network.variables[0].index].stiffness, 10.0);
}

TEST(Parallel, ASignalIsStillOfItsLinkWhenThoseBeforeItAreGone) {
  const scene::Scene scene =
      reduced(on_three_links(1, "signals:\n  tension: {of: third, quantity: force}\n"));

  ASSERT_EQ(scene.network.links.size(), 2u);
  EXPECT_EQ(scene.network.links[scene.signals.signals()[0].index].viscosity, 0.03);
}

TEST(Parallel, WhereASignalReportsTheEnergyDifferentRestLengthsStay) {
  const std::string text = on_three_links(1, "signals:\n  e: {quantity: elastic_energy}\n");

  EXPECT_EQ(reduced(text).network.links.size(), 2u);  // the damper has none
}

TEST(Parallel, NothingIsMergedUnlessAskedFor) {
  std::string text = on_three_links(1);
  text.replace(text.find("reduce: [parallel]\n"), 19, "");

  const scene::Scene scene = reduced(text);

  EXPECT_EQ(scene.network.links.size(), 3u);
  EXPECT_TRUE(scene.reductions.empty());
  EXPECT_EQ(scene.whole, nullptr);
}

TEST(Reduce, IsDoneByItselfForASceneWithAnAccuracyUnlessRefused) {
  const std::string text = on_three_links(1);
  const auto with = [&](const std::string& reduce) {
    std::string changed = text;
    changed.replace(changed.find("reduce: [parallel]\n"), 19,
                    "accuracy: {tolerance: 0.01, band_hz: 20}\n" + reduce);
    return reduced(changed).network.links.size();
  };

  EXPECT_EQ(with(""), 1u);
  EXPECT_EQ(with("reduce: none\n"), 3u);
  EXPECT_EQ(with("reduce: {parallel: false}\n"), 3u);
  EXPECT_EQ(with("reduce: {series: false}\n"), 1u);
}

TEST(Reduce, AWordThatIsNoReductionIsAnError) {
  std::string text = on_three_links(1);
  text.replace(text.find("[parallel]"), 10, "[paralel]");
  EXPECT_NE(refusal_of(text).find("parallel"), std::string::npos);
  text.replace(text.find("[paralel]"), 9, "[massless]");
  EXPECT_NE(refusal_of(text).find("a reduction is parallel, series or dimension"),
            std::string::npos);
  text.replace(text.find("[massless]"), 10, "nothing");
  EXPECT_NE(refusal_of(text).find("'reduce' must be all, none"), std::string::npos);
}

}  // namespace
}  // namespace cordis::plan
