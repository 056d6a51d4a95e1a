// sim_node/sim_config.cpp
#include "sim_node/sim_config.h"

#include <filesystem>
#include <string_view>
#include <utility>

#include "node/config/mapping_reader.h"
#include "node/config/regular_file.h"
#include "sim_node/checks/device_check.h"
#include "sim_node/checks/planned_scene.h"
#include "sim_node/checks/stability_check.h"

namespace cordis::sim {
namespace {

constexpr std::size_t kMaxSceneBytes = std::size_t{16} << 20;

/// True if a file says that it is written for Cordis, or cannot be read, which the reader reports.
/// What is wrong in another file would report what stands in it.
bool is_of_cordis(const std::filesystem::path& file) {
  const config::FileBytes read = config::read_regular_file(file.string(), kMaxSceneBytes);
  if (!read.reason.empty()) return true;
  constexpr std::string_view kMark = "cordis:";
  for (std::size_t position = read.bytes.find(kMark); position != std::string::npos;
       position = read.bytes.find(kMark, position + 1)) {
    if (position == 0 || read.bytes[position - 1] == '\n') return true;
  }
  return false;
}

/// Checks every port of a scene against the device files of the launch, and its stability.
scene::Scene checked(PlannedScene planned, const config::Launch& launch, bool force, SceneUse use,
                     config::Problems& problems) {
  if (!problems.has_errors()) {
    check_devices(launch, planned.scene, problems, use);
    check_stability(planned.scene, force, problems);
  }
  return std::move(planned.scene);
}

}  // namespace

SimSection read_sim_section(const config::LaunchNode& node, config::Problems& problems) {
  SimSection section;
  config::MappingReader reader(node.section, "node '" + node.name + "'", problems);
  section.scene_file = reader.required_text("scene");
  section.duration_s = reader.optional_number("duration_s", 0.0, config::Range::not_negative());
  section.force = reader.optional_truth("force", false);
  section.paused = reader.optional_truth("paused", false);
  section.delay_quantile =
      reader.optional_number("delay_quantile", 0.95, config::Range::between(0.5, 1.0));
  section.signals_for = reader.optional_text("signals_for", "");
  for (const config::Value& recorder : reader.optional_sequence("recorded_by").items()) {
    section.recorded_by.push_back(recorder.text());
    if (recorder.text().empty())
      reader.error_at("recorded_by",
                      "recorded_by must be a list of names, got " + recorder.described());
  }
  section.threads = static_cast<std::size_t>(
      reader.optional_integer_or("threads", "auto", kFastest, 1, kMaxThreads));
  section.scene_place = reader.place_of("scene");
  reader.finish();
  return section;
}

SimConfig read_sim_config(const config::Launch& launch, const config::LaunchNode& node,
                          config::Problems& problems) {
  const SimSection section = read_sim_section(node, problems);
  SimConfig sim{section.duration_s,
                section.force,
                section.paused,
                section.delay_quantile,
                section.signals_for,
                section.recorded_by,
                section.threads,
                {},
                {}};
  if (section.scene_file.empty()) return sim;
  sim.scene =
      load_checked_scene(launch, section.scene_file, section.scene_place, sim.force, problems);
  sim.source = {sim.scene.file, problems.sources(), engine::to_string(sim.scene.network.integrator),
                sim.scene.step_rate_hz};
  return sim;
}

scene::Scene load_checked_scene(const config::Launch& launch, const std::string& path,
                                const config::Place& referrer, bool force,
                                config::Problems& problems) {
  return checked(plan_scene(launch.resolve(path).string(), referrer, problems), launch, force,
                 SceneUse::kFirst, problems);
}

scene::Scene load_next_scene(const config::Launch& launch, const std::string& path, bool force,
                             config::Problems& problems) {
  const std::filesystem::path folder = launch.real_folder();
  const std::filesystem::path file = launch.find_below(path);
  if (file.empty()) {
    problems.error({},
                   "'" + path + "' is not below '" + folder.string() +
                       "', the folder of the launch file, from where alone scenes are loaded",
                   "start the session with it: sim.scene=" + path);
    return {};
  }
  std::error_code unknown;
  if (!std::filesystem::exists(file.parent_path(), unknown)) {
    problems.error({}, "there is no such file, neither where `cordis ctl` was called nor in '" +
                           folder.string() + "', the folder of the launch file");
    return {};
  }
  if (!is_of_cordis(file)) {
    problems.error({path, 0, 0}, "this is no scene: it has no line that begins with 'cordis: 1'");
    return {};
  }
  problems.read_below(folder.string());
  PlannedScene planned = plan_scene(file.string(), {}, problems);
  problems.read_below({});  // the launch file may name device files of any folder
  return checked(std::move(planned), launch, force, SceneUse::kLater, problems);
}

}  // namespace cordis::sim
