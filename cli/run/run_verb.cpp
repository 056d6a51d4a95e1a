// cli/run/run_verb.cpp -- cordis run: starts the nodes of a launch file and ends them together.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/programs.h"
#include "cli/run/node_check.h"
#include "cli/run/session.h"
#include "cli/verbs.h"
#include "node/runtime_folder.h"
#include "node/session_registry.h"

namespace cordis::cli {
namespace {

config::Launch read_launch(const RunOptions& options) {
  config::Problems problems;
  config::Launch launch = config::load_launch(options.launch_file, options.overrides, problems);
  problems.throw_if_any();
  for (const config::Problem& warning : problems.all()) {
    std::fprintf(stderr, "%s\n", warning.text().c_str());
  }
  return launch;
}

int run(const RunOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  setenv("CORDIS_LAUNCHED", "1", /*replace=*/1);
  StopSignals signals;
  const config::Launch launch = read_launch(options);
  RunPlan plan = plan_run(launch, options, program_directory());
  if (options.dry_run) {
    for (const PlannedNode& node : plan.nodes) std::puts(shell_line(node.command.words).c_str());
    return kSuccess;
  }
  node::SessionRegistration registration(
      node::runtime_folder(), {launch.session, launch.domain,
                               std::filesystem::absolute(launch.file).string(), names_of(plan)});
  if (!launch.domain) name_domain(plan, registration.domain());
  if (const std::optional<int> refused = check_nodes(plan, signals)) return *refused;
  return run_session(launch, plan, options, registration, signals);
}

struct RunWords {
  RunOptions options;
  std::string duration;
};

}  // namespace

void add_run_verb(CommandLine& line) {
  auto words = std::make_shared<RunWords>();
  RunOptions& options = words->options;
  Verb& verb = line.verb("run", "FILE [NAME.key=value ...] [options]",
                         "Start the nodes of a launch file, and end them together");
  verb.required_word("FILE", options.launch_file, "The launch file");
  verb.more_words("NAME.key=value", options.overrides, "Replace a value of the file, for one run");
  verb.option("--duration", "TIME", words->duration, "End after so long: 500ms, 10s, 2min, 1h");
  verb.list("--only", "NAME,...", options.only, "Start these nodes alone");
  verb.flag("--dry-run", options.dry_run, "Print the commands instead of starting them");
  verb.option("--log-dir", "DIR", options.log_directory,
              "Also write what each node says into DIR/NAME.log");
  verb.flag("--no-color", options.no_color, "No colours, even on a terminal");
  verb.examples(
      "--duration is simulated time in a lockstep or asap session; in a realtime session\n"
      "it counts from the moment all nodes run.\n"
      "Each session has a DDS domain of its own on its host, which the first line names;\n"
      "domain=N chooses one, which a session on several hosts needs.\n"
      "Ctrl-C stops the devices first, the scene last; a second one kills.\n"
      "A node that dies starts again after 0.2, 1, 5 s, at most 5 times in a minute, unless the\n"
      "launch file says 'respawn: false'. In a lockstep or asap session only a viz_node does.\n"
      "The session ends when a required node (any but a viz_node, unless the file says\n"
      "otherwise) ends or is given up.\n"
      "Exit code: 0 all well, else that of the first required node that was given up:\n"
      "1 failed at run time, 2 bad file or command line, 128 + signal when it was killed.\n\n"
      "Examples:\n"
      "  cordis run launch_configs/plucked_string.yaml\n"
      "  cordis run launch_configs/plucked_string.yaml keyboard.driver=script view.port=8081\n"
      "  cordis run launch_configs/plucked_string.yaml clock=lockstep --duration 10s --only "
      "sim,keyboard\n");
  verb.action([words] {
    if (!words->duration.empty()) words->options.duration = parse_duration(words->duration);
    return run(words->options);
  });
}

}  // namespace cordis::cli
