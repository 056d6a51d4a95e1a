// tests/install/outside/play_scene.cpp -- a program of somebody else that reads and steps a scene.
//
// Reads a scene in YAML, steps it for a second of its time, and prints where its matter is.
// usage: play_scene SCENE
#include <cstdio>
#include <exception>

#include <cordis/scene_file.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const cordis::SceneFile scene = cordis::SceneFile::load(argv[1]);
    cordis::engine::World world(scene.network());
    for (int n = 0; n < static_cast<int>(scene.step_rate_hz()); ++n) {
      if (world.step().non_finite_mats != 0) return 1;
    }
    for (const cordis::SceneName& matter : scene.matter()) {
      const cordis::engine::Vec3 position = world.position(matter.first);
      std::printf("%s: %u MATs, the first at %.6f %.6f %.6f m\n", matter.name.c_str(), matter.count,
                  position.x(), position.y(), position.z());
    }
    std::vector<double> values(scene.signals().size());
    scene.read_signals(world, values.data());
    for (std::size_t s = 0; s < values.size(); ++s) {
      std::printf("%s = %.6g\n", scene.signals()[s].c_str(), values[s]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
