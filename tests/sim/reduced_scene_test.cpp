// tests/sim/reduced_scene_test.cpp
#include <array>

#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/run/describe.h"
#include "tests/sim/loaded_scenes.h"

namespace cordis::sim {
namespace {

std::shared_ptr<const scene::Scene> reduced_scene_of(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = plan::reduce(scene::load_scene_text(text, "t", problems), problems);
  EXPECT_EQ(problems.text(), "");
  return std::make_shared<const scene::Scene>(std::move(scene));
}

std::string swing_in_a_plane() {
  return R"(cordis: 1
space: 3
step: {rate_hz: 1000}
reduce: all
liaisons: {s: {kind: spring, stiffness_n_per_m: 100, rest_m: 0.1}}
matter:
  wall: {kind: fixed, at_m: [0, 0.5, 0]}
  bob: {kind: mass, mass_kg: 0.1, at_m: [0.2, 0.5, 0], velocity_m_per_s: [1, 0, 0.1]}
links:
  - {liaison: s, between: [wall, bob]}
)";
}

TEST(ReducedScene, IsShownInTheSpaceOfItsFile) {
  const auto scene = reduced_scene_of(swing_in_a_plane());
  ASSERT_EQ(scene->space(), 2);
  const FrameLayout layout = layout_of(*scene);
  const std::array<double, 3> position{7.0, 8.0, 0.0};
  std::array<float, 3> shown{};

  layout.show(0, position.data(), shown.data());

  EXPECT_EQ(shown, (std::array<float, 3>{7.0F, 0.5F, 8.0F}));
  EXPECT_EQ(describe(*scene, 1, 1).space(), 3u);
}

}  // namespace
}  // namespace cordis::sim
