// cli/lab/lab_scene.h -- a scene and its gesture, ready to be tried out.
#pragma once

#include <string>
#include <vector>

#include "sim_node/plan/course.h"
#include "sim_node/scene/scene.h"

namespace cordis::cli {

struct LabScene {
  scene::Scene scene;
  plan::Course course;
  std::vector<std::string> ports;  ///< what each port does, for a person
};

/// Reads a scene, whose ports then rest, or a launch file, whose simulated devices play once at the
/// scene's own rate: what they did is the gesture of all runs. @throws config::ConfigError
LabScene load_lab_scene(const std::string& file, double duration_s);

}  // namespace cordis::cli
