// cli/run/run_verb.cpp
#include "cli/run/run_verb.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/programs.h"
#include "cli/run/node_check.h"
#include "cli/run/running_nodes.h"
#include "cli/run/session.h"
#include "cli/table/table_options.h"
#include "node/random_token.h"
#include "node/runtime_folder.h"
#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "node/session_key.h"
#include "node/session_network.h"
#include "node/session_registry.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

config::Launch read_launch(const RunOptions& options) {
  config::Problems problems;
  config::Launch launch = config::load_launch(options.launch_file, options.overrides, problems);
  if (problems.has_errors())
    node::print_text(stderr, check_faulty_launch(options.launch_file, options.overrides,
                                                 problems.all(), /*with_sim=*/true));
  problems.throw_if_any();
  for (const config::Problem& warning : problems.all()) {
    node::print_text(stderr, warning.text() + "\n");
  }
  return launch;
}

/// The key of the launcher. Its folder has the key of commands too, unless the user has chosen one.
dds::Security security_of_launcher(const std::string& keyring) {
  if (keyring.empty()) return {};
  using node::Role;
  const node::Identity identity =
      node::identity_in(keyring,
                        {Role::kLauncher, Role::kController, Role::kView, Role::kViewThatCommands,
                         Role::kRecorder, Role::kDevice, Role::kSim},
                        "");
  setenv("CORDIS_SESSION_KEY_FILE", node::SharedKeyFiles(keyring).command_key.c_str(),
         /*replace=*/0);
  return identity.security;
}

/// What the launch file means on this host. @throws ConfigError
dds::Network network_on_this_host(const config::Launch& launch) {
  config::Problems problems;
  dds::Network network = node::network_of(launch, problems);
  problems.throw_if_any();
  return network;
}

int run(const RunOptions& options) {
  std::signal(SIGPIPE, SIG_IGN);
  setenv("CORDIS_LAUNCHED", "1", /*replace=*/1);
  // A viz_node that is started again keeps its pages: viz_node/main.cpp.
  setenv("CORDIS_PAGE_TOKEN", node::random_token().c_str(), /*replace=*/0);
  const config::Launch launch = read_launch(options);
  StopSignals signals;
  RunPlan plan = plan_run(launch, options, program_directory());
  if (options.dry_run) {
    for (const PlannedNode& node : plan.nodes) std::puts(shell_line(node.command.words).c_str());
    return kSuccess;
  }
  const bool simulates = std::ranges::any_of(
      plan.nodes, [](const PlannedNode& node) { return node::simulates(node.program); });
  const dds::Network network = network_on_this_host(launch);
  const std::string keyring = node::keyring_of(launch);
  const dds::Security security = security_of_launcher(keyring);
  node::SessionRegistration registration(
      node::runtime_folder(), {.session = launch.session,
                               .domain = launch.domain,
                               .launch_file = std::filesystem::absolute(launch.file).string(),
                               .nodes = names_of(plan),
                               .simulates = simulates,
                               .network = network,
                               .keyring = keyring,
                               .has_key = true});
  // The nodes find it there; the key itself stands in no environment.
  setenv("CORDIS_SESSION_KEY_FILE",
         node::registered_key_file(node::runtime_folder(), launch.session, registration.domain())
             .c_str(),
         /*replace=*/1);
  if (!launch.domain) name_domain(plan, registration.domain());
  const NodeCheck check = check_nodes(plan, signals);
  node::print_text(stderr, check.said);
  if (check.refused) return *check.refused;
  refuse_running_nodes(plan, launch.session, registration.domain());
  return run_session(launch, plan, options, registration, network, security, signals);
}

struct RunWords {
  RunOptions options;
  std::string duration;
  std::string record;
};

/// Words that make a record_node write this file, whatever the launch file says of one. It is started
/// too where only some nodes are.
void record_into(const std::string& file, RunOptions& options) {
  std::string quoted = "'";
  for (const char c : std::filesystem::absolute(file).string())
    quoted += c == '\'' ? std::string("''") : std::string(1, c);
  options.overrides.push_back("record.out=" + quoted + "'");
  const bool is_named = std::ranges::find(options.only, kRecorder) != options.only.end();
  if (!options.only.empty() && !is_named) options.only.emplace_back(kRecorder);
}

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
  verb.option("--record", "FILE", words->record,
              "Record the session into this file (MCAP), with --only as well");
  verb.flag("--dry-run", options.dry_run, "Print the commands instead of starting them");
  verb.option("--log-dir", "DIR", options.log_directory,
              "Also write what each node says into DIR/NAME.log");
  verb.option("--signals", "FILE", options.signals_file,
              "Also write the signals of the scene into a table, a row per gesture period");
  verb.option("--summary", "FILE", options.summary_file,
              "Also write least, largest, mean and last value of each signal, and how each node "
              "ended, as JSON");
  verb.flag("--no-color", options.no_color, "No colours, even on a terminal");
  verb.examples(
      "--duration is simulated time in a lockstep or asap session; in a realtime session\n"
      "it counts from the moment all nodes run, at the latest from 5 s after the start.\n"
      "Each session has a DDS domain of its own on its host, which the first line names;\n"
      "domain=N chooses one, which a session on several hosts needs.\n"
      "--signals and --summary take what comes over DDS, from the first row on; in lockstep and\n"
      "asap every row comes, else those that do not are counted. Rows of a scene with other\n"
      "signals are left out and counted, at the end and in 'other_rows' of the summary. For more\n"
      "than signals: `cordis simulate`, or a recording.\n"
      "Ctrl-C stops the devices first, the scene last; a second one kills.\n"
      "A node that dies starts again after 0.2, 1, 5 s, at most 5 times in a minute, unless the\n"
      "launch file says 'respawn: false'. In a lockstep or asap session only a viz_node and a\n"
      "record_node do. The session ends when a required node ends or is given up: any but a\n"
      "viz_node and a record_node, unless the file says otherwise.\n"
      "Exit code: 0 all well, else that of the first required node that was given up:\n"
      "1 failed at run time, 2 bad file or command line, 128 + signal when it was killed.\n"
      "1 too where a required node was down at the end, and where the take of --record failed.\n"
      "1 too where --duration is over and no device has joined for any port, of this launch file "
      "or\n"
      "another program. In lockstep wall time counts for that, at least 5 s.\n"
      "1 too where the board of a required device was never connected, and no hot standby\n"
      "played the device. The end says so; 'complete' of the summary is false then, and its\n"
      "'nodes' has the phase of each node, with the reason.\n\n"
      "Examples:\n"
      "  cordis run launch_configs/plucked_string.yaml\n"
      "  cordis run launch_configs/plucked_string.yaml keyboard.driver=script view.port=8081\n"
      "  cordis run launch_configs/plucked_string.yaml clock=lockstep --duration 10s --only "
      "sim,keyboard\n");
  verb.action([words] {
    if (!words->record.empty()) record_into(words->record, words->options);
    words->options.records = !words->record.empty();
    if (!words->duration.empty()) words->options.duration = parse_duration(words->duration);
    const NamedFile signals{"--signals", words->options.signals_file};
    const NamedFile summary{"--summary", words->options.summary_file};
    const NamedFile take{"--record", words->record};
    refuse_shared_files({{"FILE", words->options.launch_file}, signals, summary, take});
    refuse_overwriting({signals, summary}, {});
    return run(words->options);
  });
}

}  // namespace cordis::cli
