// sim_node/sim_config.h -- what a launch file says about a sim_node.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/config/launch.h"
#include "sim_node/run/request_source.h"
#include "sim_node/run/thread_count.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The keys of a sim_node's section in a launch file.
struct SimSection {
  std::string scene_file;     ///< `scene`: as a person wrote it; relative to the launch file
  config::Place scene_place;  ///< where that path stands
  /// `duration_s`: simulated time after which the node ends by itself [s]; 0 = never
  double duration_s = 0.0;
  bool force = false;   ///< `force`: a scene that is surely unstable runs all the same
  bool paused = false;  ///< `paused`: the scene is paused at its start
  /// `delay_quantile`: the share of the answers to a device that come within the delay for which
  /// its limits are computed
  double delay_quantile = 0.95;
  std::size_t threads = kFastest;  ///< `threads`: how many share a step
  /// `signals_for`: the node that gets every row of scene/signals; empty: none waits
  std::string signals_for;
  /// `recorded_by`: record_nodes that get all answers and signals; empty: none waits
  std::vector<std::string> recorded_by;
};

/// Reads the section alone, not the scene. What is wrong becomes a problem.
SimSection read_sim_section(const config::LaunchNode& node, config::Problems& problems);

/// What a sim_node runs.
struct SimConfig {
  double duration_s = 0.0;               ///< duration from the section
  bool force = false;                    ///< `force` of the section
  bool paused = false;                   ///< `paused` of the section
  double delay_quantile = 0.95;          ///< quantile from the section
  std::string signals_for;               ///< `signals_for` of the section
  std::vector<std::string> recorded_by;  ///< `recorded_by` of the section
  std::size_t threads = kFastest;        ///< `threads` of the section
  scene::Scene scene;                    ///< what the file of the section says
  SceneSource source;                    ///< source of the scene
};

/// Reads the section and the scene, checks every port against the device files of the same launch,
/// and the stability of the scene. All that is wrong becomes a problem; the result is usable when
/// there is none.
SimConfig read_sim_config(const config::Launch& launch, const config::LaunchNode& node,
                          config::Problems& problems);

/// Reads a scene and checks every port against the device files of the launch, and its stability.
/// @param path  as a person wrote it; relative to the launch file
scene::Scene load_checked_scene(const config::Launch& launch, const std::string& path,
                                const config::Place& referrer, bool force,
                                config::Problems& problems);

/// Loads the scene of a path that a command names: every process of the session may send one. It
/// reads regular files below the folder of the launch file alone, links and `..` resolved, the one of
/// the path if it says it is one of Cordis; the answer reveals nothing of any other. `cordis ctl` sends a whole path when
/// it finds the file where it is called, else the path as it was written.
scene::Scene load_next_scene(const config::Launch& launch, const std::string& path, bool force,
                             config::Problems& problems);

}  // namespace cordis::sim
