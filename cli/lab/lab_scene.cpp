// cli/lab/lab_scene.cpp
#include "cli/lab/lab_scene.h"

#include "cli/lab/stage.h"
#include "node/config/value.h"

namespace cordis::cli {
namespace {

/// Plays the launch file once, and keeps what its devices did.
void record(Stage& stage, double duration_s, LabScene& lab) {
  lab.scene = stage.scene();
  lab.course.period = 1.0 / lab.scene.gesture_rate_hz;
  std::vector<const scene::Port*> played;
  for (const scene::Port& port : lab.scene.ports) {
    if (!stage.plays(port)) {
      lab.ports.push_back(port.name + " rests: '" + port.device + "' is no simulated device");
      continue;
    }
    const bool is_force = port.role == scene::Role::kLiaison;
    lab.ports.push_back(port.name + " is played by '" + port.device + "' (" +
                        stage.driver_of(port) + "), as in one run at the scene's own rate");
    played.push_back(&port);
    lab.course.tracks.push_back({port.mat, is_force, {}});
    if (!is_force) lab.course.tracks.back().value.push_back(port.rest);
  }
  if (played.empty()) return;
  stage.play_until(duration_s, [&] {
    for (std::size_t p = 0; p < played.size(); ++p) {
      lab.course.tracks[p].value.push_back(stage.given(*played[p]));
    }
  });
}

}  // namespace

LabScene load_lab_scene(const std::string& file, double duration_s) {
  config::Problems problems;
  const config::Value root = config::load_file(file, problems);
  problems.throw_if_any();
  LabScene lab;
  if (root.find("nodes").exists()) {
    Stage stage(file);
    record(stage, duration_s, lab);
    return lab;
  }
  lab.scene = scene::load_scene(file, problems);
  problems.throw_if_any();
  for (const scene::Port& port : lab.scene.ports) {
    lab.ports.push_back(port.name + " rests: give the launch file to have it played");
  }
  return lab;
}

}  // namespace cordis::cli
