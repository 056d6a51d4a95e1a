#include <array>

#include "sim_node/checks/strut_watch.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/run/describe.h"
#include "tests/sim/stages.h"

namespace cordis::sim {
namespace {

std::shared_ptr<const scene::Scene> reduced_scene_of(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = plan::reduce(scene::load_scene_text(text, "t", problems), problems);
  EXPECT_EQ(problems.text(), "");
  return std::make_shared<const scene::Scene>(std::move(scene));
}

std::string row_in_a_plane(const std::string& velocity) {
  return "cordis: 1\nspace: 3\nstep: {rate_hz: 1000}\nreduce: all\n"
         "liaisons: {s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0.1}}\n"
         "matter:\n"
         "  wall: {kind: fixed, at_m: [0, 0.5, 0]}\n"
         "  joint: {kind: mass, mass_kg: 0, at_m: [0.1, 0.5, 0]}\n"
         "  bob: {kind: mass, mass_kg: 0.1, at_m: [0.2, 0.5, 0], velocity_m_per_s: [" +
         velocity +
         ", 0, 0.1]}\n"
         "links:\n"
         "  - {liaison: s, between: [wall, joint], name: first}\n"
         "  - {liaison: s, between: [joint, bob]}\n";
}

TEST(ReducedScene, IsShownInTheSpaceOfItsFile) {
  const auto scene = reduced_scene_of(row_in_a_plane("1"));
  ASSERT_EQ(scene->space(), 2);
  const FrameLayout layout = layout_of(*scene);
  const std::array<double, 3> position{7.0, 8.0, 0.0};
  std::array<float, 3> shown{};

  layout.show(0, position.data(), shown.data());

  EXPECT_EQ(shown, (std::array<float, 3>{7.0F, 0.5F, 8.0F}));
  EXPECT_EQ(describe(*scene, 1, 1).space(), 3u);
}

TEST(StrutWatch, TellsWhichRowIsPushed) {
  const auto pushed_after = [](const std::string& velocity) {
    const auto scene = reduced_scene_of(row_in_a_plane(velocity));
    engine::World world(std::make_shared<const engine::Network>(scene->network));
    StrutWatch watch(*scene);
    for (int n = 0; n < 20; ++n) {
      world.step();
      watch.look(world);
    }
    return watch.worst();
  };

  EXPECT_EQ(pushed_after("1"), -1);
  EXPECT_EQ(pushed_after("-1"), 0);
  const auto scene = reduced_scene_of(row_in_a_plane("1"));
  EXPECT_EQ(texts_of_struts(*scene)[0].find("the row first is pushed"), 0u);
}

}  // namespace
}  // namespace cordis::sim
