// cli/run/run_plan.cpp
#include "cli/run/run_plan.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "cli/command_line.h"
#include "cli/duration.h"
#include "idl/topics.h"
#include "node/config/nearest_word.h"
#include "node/config/problem.h"
#include "record_node/mcap/topic_glob.h"
#include "record_node/record_config.h"

namespace cordis::cli {
namespace {

struct Role {
  std::string_view program;
  int start_place;
  int stop_stage;
};
// A device stops first, so that the hand is released before the scene is gone. A recorder
// starts first and stops last; what is said before it has found a writer is not recorded.
constexpr std::array<Role, 4> kRoles{
    {{"record_node", 0, 3}, {"sim_node", 1, 2}, {"device_node", 2, 0}, {"viz_node", 3, 1}}};

const Role& role_of(const std::string& program) {
  for (const Role& role : kRoles) {
    if (role.program == program) return role;
  }
  throw std::logic_error("a launch file with a program of unknown kind was let through: " +
                         program);
}

void check_names(const std::vector<std::string>& only, const config::Launch& launch) {
  std::vector<std::string> names;
  for (const config::LaunchNode& node : launch.nodes) names.push_back(node.name);
  for (const std::string& name : only) {
    if (launch.find(name) != nullptr) continue;
    const std::string near = config::nearest_word(name, names);
    throw UsageError("--only: " + launch.file + " has no node '" + name + "'" +
                     (near.empty() ? "" : ", did you mean '" + near + "'?"));
  }
}

bool is_wanted(const std::string& name, const std::vector<std::string>& only) {
  return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
}

/// True if a record_node stores what a scene answers to devices, and its signals.
bool records_answers(const config::LaunchNode& node) {
  config::Problems reported_by_the_node;
  const record::RecordSection section = record::read_record_section(node, reported_by_the_node);
  const std::array topics{msg::TOPIC_FORCES, msg::TOPIC_POSITIONS, msg::TOPIC_SIGNALS};
  return std::ranges::all_of(topics, [&](const std::string& topic) {
    return mcap::matches_topic(topic, section.topics) &&
           (section.excluded.empty() || !mcap::matches_topic(topic, section.excluded));
  });
}

/// The recorders of a run without real time, for which its scene waits: "[record, other]".
std::string recorders_of(const config::Launch& launch, const RunOptions& options) {
  std::string names;
  if (launch.clock == config::Clock::kRealtime) return names;
  for (const config::LaunchNode& node : launch.nodes) {
    if (node.program != "record_node" || !is_wanted(node.name, options.only)) continue;
    if (records_answers(node)) names += (names.empty() ? "[" : ",") + node.name;
  }
  return names.empty() ? names : names + "]";
}

bool is_plain(char c) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  return kPlain.find(c) != std::string_view::npos;
}

}  // namespace

RunPlan plan_run(const config::Launch& launch, const RunOptions& options,
                 const std::filesystem::path& programs) {
  check_names(options.only, launch);
  RunPlan plan;
  plan.wall_duration = options.duration;
  std::vector<std::string> words = options.overrides;
  const std::string recorders = recorders_of(launch, options);
  for (const config::LaunchNode& node : launch.nodes) {
    if (!is_wanted(node.name, options.only)) continue;
    plan.nodes.push_back({node.name, node.program, node.required, node.respawn});
    const bool wants_signals = !options.signals_file.empty() || !options.summary_file.empty();
    if (wants_signals && node.program == "sim_node")
      words.push_back(node.name + ".signals_for=" + kLauncherNode);
    if (!recorders.empty() && node.program == "sim_node")
      words.push_back(node.name + ".recorded_by=" + recorders);
    if (options.duration && node.program == "sim_node" &&
        launch.clock != config::Clock::kRealtime) {
      words.push_back(node.name + ".duration_s=" + in_seconds(*options.duration));
      plan.wall_duration.reset();
      plan.nodes.back().required = true;  // its end is the end of the run
    }
  }
  std::stable_sort(plan.nodes.begin(), plan.nodes.end(),
                   [](const PlannedNode& a, const PlannedNode& b) {
                     return role_of(a.program).start_place < role_of(b.program).start_place;
                   });
  for (PlannedNode& node : plan.nodes) {
    node.command.stop_stage = role_of(node.program).stop_stage;
    node.command.drives_motors = node.program == "device_node";
    node.command.writes_takes = node.program == "record_node";
    node.command.words = {programs / node.program, launch.file, "--name", node.name};
    node.command.words.insert(node.command.words.end(), words.begin(), words.end());
  }
  return plan;
}

std::vector<std::string> names_of(const RunPlan& plan) {
  std::vector<std::string> names;
  for (const PlannedNode& node : plan.nodes) names.push_back(node.name);
  return names;
}

void name_domain(RunPlan& plan, int domain) {
  for (PlannedNode& node : plan.nodes)
    node.command.words.push_back("domain=" + std::to_string(domain));
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace cordis::cli
