// node/node_main.cpp
#include "node/node_main.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <vector>

#include "node/background_work.h"
#include "node/inherited_priority.h"
#include "node/log.h"
#include "node/paced_loop.h"
#include "node/runtime_folder.h"
#include "node/session_network.h"
#include "node/session_registry.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "node/time.h"

namespace cordis::node {
namespace {

constexpr int kRuntimeFailure = 1;
constexpr int kDdsPriority = 40;  // SCHED_FIFO
static_assert(kDdsPriority < kLoopPriority);

struct Arguments {
  std::string launch_file;
  std::string name;
  bool check_only = false;
  bool help = false;
  std::vector<std::string> overrides;
};

/// @throws std::invalid_argument with what is wrong with the command line.
Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h") {
      arguments.help = true;
    } else if (word == "--check") {
      arguments.check_only = true;
    } else if (word == "--name") {
      if (++i == argc) throw std::invalid_argument("--name needs the name of a node");
      arguments.name = argv[i];
    } else if (word.starts_with("--name=")) {
      arguments.name = word.substr(std::strlen("--name="));
    } else if (word.starts_with("-")) {
      throw std::invalid_argument("unknown option '" + word + "'");
    } else if (arguments.launch_file.empty()) {
      arguments.launch_file = word;
    } else {
      arguments.overrides.push_back(word);
    }
  }
  if (!arguments.help && arguments.launch_file.empty())
    throw std::invalid_argument("which launch file?");
  return arguments;
}

std::string usage(const std::string& kind) {
  return "usage: " + kind + " LAUNCH.yaml [--name NAME] [--check] [NAME.key=value ...]\n\n" +
         "Runs one node of a launch file by itself. `cordis run LAUNCH.yaml` starts them all.\n" +
         "  --name NAME      which node of the file; not needed when it has a single " + kind +
         "\n" + "  --check          read and check everything the node would use, then end\n" +
         "  NAME.key=value   replaces a value of the file\n" +
         "  domain=N         its DDS domain; else that of the running session of its name, else "
         "a\n" +
         "                   free one\n\n" + "example: " + kind +
         " launch_configs/plucked_string.yaml\n";
}

const config::LaunchNode* choose(const config::Launch& launch, const std::string& kind,
                                 const std::string& name) {
  std::string names;
  int matching = 0;
  const config::LaunchNode* chosen = nullptr;
  for (const auto& node : launch.nodes) {
    if (node.program != kind) continue;
    names += (names.empty() ? "'" : ", '") + node.name + "'";
    ++matching;
    if (name.empty() || node.name == name) chosen = &node;
  }
  if (name.empty() && matching > 1) {
    throw std::invalid_argument(launch.file + " has several: --name one of " + names);
  }
  if (chosen == nullptr) {
    throw std::invalid_argument(launch.file + " has no " + kind +
                                (name.empty() ? "" : " named '" + name + "'") +
                                (names.empty() ? "" : ", only " + names));
  }
  return chosen;
}

/// What a program of the launch file can be in a secured session, the preferred role first.
std::vector<Role> roles_of(const std::string& program) {
  if (program == "sim_node") return {Role::kSim};
  if (program == "device_node") return {Role::kDevice};
  if (program == "record_node") return {Role::kRecorder};
  return {Role::kViewThatCommands, Role::kView};
}

/// Records a node that runs by itself. The launcher has recorded those that it starts, and names
/// their domain.
void join_session(NodeStart& start, std::optional<SessionRegistration>& registration) {
  const config::Launch& launch = start.launch;
  if (!launch.domain || std::getenv("CORDIS_LAUNCHED") == nullptr) {
    registration.emplace(runtime_folder(),
                         SessionRequest{launch.session,
                                        launch.domain,
                                        std::filesystem::absolute(launch.file).string(),
                                        {start.node->name},
                                        /*is_player=*/false,
                                        simulates(start.node->program),
                                        start.network,
                                        keyring_of(launch)});
    if (!launch.domain)
      spdlog::info("session '{}' in DDS domain {}", launch.session, registration->domain());
    const std::string warning =
        exposure_warning(start.network, registration->domain(), start.identity.has_value());
    if (!warning.empty()) spdlog::warn("{}", warning);
  }
  start.domain = registration ? registration->domain() : *launch.domain;
  start.key = key_of_session(launch.session, start.domain);
}

void print_problems(const std::vector<config::Problem>& problems) {
  for (const auto& problem : problems) print_text(stderr, problem.text() + "\n");
}

}  // namespace

dds::ParticipantConfig NodeStart::config() const {
  dds::ParticipantConfig config{domain, launch.session, node->name,
                                launch.clock == config::Clock::kLockstep, launch.has_standbys()};
  config.network = network;
  config.clock = config::clock_word(launch.clock);
  if (identity) config.security = identity->security;
  return config;
}

CommandGuard NodeStart::command_guard() const {
  return {key, launch.session, {node->name, epoch}};
}

dds::Participant NodeStart::join_for_force_loop() const {
  dds::ParticipantConfig of_the_loop = config();
  of_the_loop.node += "/loop";
  of_the_loop.for_loop = true;
  if (launch.clock != config::Clock::kRealtime) return dds::Participant(of_the_loop);
  const InheritedPriority priority(kDdsPriority);
  return dds::Participant(of_the_loop);
}

namespace {

int run_and_report(int argc, char** argv, const std::string& kind,
                   int (*run)(const NodeStart&, config::Problems&)) {
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.help) {
      std::fputs(usage(kind).c_str(), stdout);
      return 0;
    }
    config::Problems problems;
    NodeStart start;
    start.launch = config::load_launch(arguments.launch_file, arguments.overrides, problems);
    // A check goes on to the files of the node, and says all that is wrong at once.
    const bool goes_on = arguments.check_only && start.launch.find(arguments.name) != nullptr;
    if (!goes_on) problems.throw_if_any();
    start.node = choose(start.launch, kind, arguments.name);
    if (!problems.has_errors()) {
      start.network = network_of(start.launch, problems);
      problems.throw_if_any();
      if (!start.launch.security.empty())
        start.identity = identity_in(keyring_of(start.launch), roles_of(kind), start.node->name);
    }
    start.check_only = arguments.check_only;
    start.epoch = static_cast<std::uint64_t>(monotonic_nsec());
    install_log(start.node->name);
    install_stop_signals();
    std::optional<SessionRegistration> registration;
    if (!start.check_only) join_session(start, registration);
    return run(start, problems);
  } catch (const config::ConfigError& error) {
    print_problems(error.problems());
    return kBadInput;
  } catch (const std::invalid_argument& error) {
    print_text(stderr, kind + ": " + error.what() + " (see " + kind + " --help)\n");
    return kBadInput;
  } catch (const std::exception& error) {
    print_text(stderr, kind + ": " + error.what() + "\n");
    return kRuntimeFailure;
  }
}

}  // namespace

int node_main(int argc, char** argv, const std::string& kind,
              int (*run)(const NodeStart&, config::Problems&)) {
  return leave_with(run_and_report(argc, argv, kind, run));
}

void report(const config::Problems& problems) {
  problems.throw_if_any();
  print_problems(problems.all());
}

}  // namespace cordis::node
