// cli/run/run_plan.h -- what `cordis run` starts, in which order, with which words.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/run/supervisor.h"
#include "node/config/launch.h"

namespace cordis::cli {

/// The name under which `cordis run` takes part in its session.
inline constexpr const char* kLauncherNode = "cordis";

/// Name of the node that --record makes.
inline constexpr const char* kRecorder = "record";

/// What a person asked for.
struct RunOptions {
  std::string launch_file;
  std::vector<std::string> overrides;                ///< words `name.key=value`
  std::optional<std::chrono::nanoseconds> duration;  ///< how long to run; until stopped when absent
  std::vector<std::string> only;                     ///< names of the nodes to start; empty = all
  std::string log_directory;                         ///< empty = no files
  std::string signals_file;                          ///< empty = none
  std::string summary_file;                          ///< empty = none
  bool records = false;                              ///< --record: the take is wanted
  bool dry_run = false;
  bool no_color = false;
};

struct PlannedNode {
  std::string name;
  std::string program;
  bool required = true;
  bool respawn = true;
  Command command{};
};

struct RunPlan {
  std::vector<PlannedNode> nodes;  ///< in the order of their start: recorder, sim, devices,
                                   ///< displays
  /// Wall time from the moment all nodes run until they are stopped; absent when sim_node ends by
  /// itself or never.
  std::optional<std::chrono::nanoseconds> wall_duration;
};

/// Makes the plan. In a lockstep or asap session a duration is simulated time: it becomes a word
/// for sim_node, which then ends by itself. Where signals are written,
/// sim_node begins when this process reads them. Without real time it begins when the recorders of
/// the plan read what it sends.
/// @param programs  folder of the executables
/// @throws UsageError when `only` names a node that the launch does not have.
RunPlan plan_run(const config::Launch& launch, const RunOptions& options,
                 const std::filesystem::path& programs);

/// Names of the nodes of the plan, in its order.
std::vector<std::string> names_of(const RunPlan& plan);

/// Gives every node of the plan the word `domain=N`.
void name_domain(RunPlan& plan, int domain);

/// The words as they can be typed into a shell.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace cordis::cli
