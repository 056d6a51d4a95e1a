// tests/fuzz/scene.cpp -- scene files: read, reduced, checked and stepped.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "node/config/problem.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/checks/start_check.h"
#include "sim_node/engine/world.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::fuzz {
namespace {

// The changes of an input may ask for a scene that is fit to run, and that none can wait for.
constexpr std::size_t kMaxChecked = 200;  // MATs, and links
constexpr int kSteps = 8;

/// What an input may include, as other.yaml.
constexpr const char* kIncluded = R"(
cordis: 1
liaisons:
  included:
    parameters: {stiffness_n_per_m: 400, soft: stiffness_n_per_m / 4}
    start: near
    states:
      near: {stiffness_n_per_m: stiffness_n_per_m, exits: [{to: far, when: elongation_m > 0.1}]}
      far: {stiffness_n_per_m: soft, exits: [{to: near, when: falling(force_n), rest: here}]}
)";

/// What was read without an error, the engine takes and steps.
void step(const scene::Scene& scene) {
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  std::vector<double> signals(scene.signals.count());
  for (int step = 0; step < kSteps; ++step) {
    static_cast<void>(world.step());
    scene.signals.read(world, signals.data());
  }
}

}  // namespace
}  // namespace cordis::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis;
  const std::string text(reinterpret_cast<const char*>(data), size);
  config::Problems problems;
  problems.read_from({{"/nowhere/other.yaml", fuzz::kIncluded}});
  scene::Scene scene = scene::load_scene_text(text, "/nowhere/input.yaml", problems);
  if (!problems.has_errors()) scene = plan::reduce(std::move(scene), problems);
  if (!problems.has_errors() && !scene.rate_is_open) {
    sim::check_start(scene, problems);
    if (scene.network.mats.size() <= fuzz::kMaxChecked && scene.link_count() <= fuzz::kMaxChecked)
      sim::check_stability(scene, false, problems);
    fuzz::step(scene);
  }
  static_cast<void>(problems.text());
  return 0;
}
