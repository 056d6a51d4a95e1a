// cli/lab/lab_scene.h -- a scene and its gesture, ready to be tried out.
#pragma once

#include <string>
#include <vector>

#include "sim_node/plan/reference/input_trajectory.h"
#include "sim_node/scene/scene.h"

namespace cordis::cli {

struct LabScene {
  scene::Scene scene;
  double duration_s = 0.0;  ///< length of a run
  plan::InputTrajectory trajectory;
  std::vector<std::string> ports;  ///< what each port does, for a person
};

/// Reads a scene, whose ports then rest, or a launch file, whose simulated devices play once at the
/// scene's own rate: what they did is the gesture of all runs.
/// @param duration_s  of a run; 0: as long as the scene asks for, or 2 s
/// @throws config::ConfigError
LabScene load_lab_scene(const std::string& file, double duration_s);

}  // namespace cordis::cli
