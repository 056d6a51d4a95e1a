// cli/run/session.cpp
#include "cli/run/session.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/run/existing_takes.h"
#include "cli/run/machine_watch.h"
#include "cli/run/node_output.h"
#include "cli/run/other_nodes.h"
#include "cli/run/respawn_policy.h"
#include "cli/run/signal_log.h"
#include "cli/run/status_board.h"
#include "node/config/count_text.h"
#include "node/dds/reader.h"
#include "node/machine/timer_watch.h"
#include "node/session_network.h"
#include "node/status_words.h"
#include "node/time.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLongestStart{5};
constexpr const char* kNoDevice =
    "no device has joined that a port of the scene plays: the ports stood still";

/// Nodes of the launch file that other launchers start.
std::vector<OtherNode> others_of(const config::Launch& launch, const RunPlan& plan) {
  const std::vector<std::string> own = names_of(plan);
  std::vector<OtherNode> others;
  for (const config::LaunchNode& node : launch.nodes) {
    if (std::find(own.begin(), own.end(), node.name) == own.end())
      others.push_back({node.name, node.required});
  }
  return others;
}

bool simulates(const RunPlan& plan) {
  return std::ranges::any_of(plan.nodes,
                             [](const PlannedNode& node) { return node.program == "sim_node"; });
}

/// The launch file and the words that change it: another launcher needs the same.
std::string launch_words(const config::Launch& launch, const RunOptions& options) {
  std::vector<std::string> words{launch.file};
  words.insert(words.end(), options.overrides.begin(), options.overrides.end());
  return shell_line(words);
}

class Session : public Watcher {
 public:
  Session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options,
          node::SessionRegistration& registration, const dds::Network& network,
          const dds::Security& security)
      : plan_(plan),
        registration_(registration),
        output_(names_of(plan), options.log_directory, options.no_color),
        others_(others_of(launch, plan), launch_words(launch, options), Clock::now()),
        first_epoch_(static_cast<std::uint64_t>(node::monotonic_nsec())),
        board_(first_epoch_),
        participant_({.domain = registration.domain(),
                      .session = launch.session,
                      .node = kLauncherNode,
                      .lockstep = launch.clock == config::Clock::kLockstep,
                      .network = network,
                      .security = security}),
        statuses_(participant_, dds::Topic::kStatus),
        present_(plan.nodes.size(), true),
        killed_(plan.nodes.size(), false),
        restarts_(plan.nodes.size(), 0),
        is_down_(plan.nodes.size(), false),
        failures_(plan.nodes.size()),
        started_(Clock::now()),
        has_devices_elsewhere_(std::ranges::any_of(launch.nodes, [&plan](const auto& node) {
          return node.program == "device_node" &&
                 std::ranges::none_of(plan.nodes, [&node](const PlannedNode& planned) {
                   return planned.name == node.name;
                 });
        })) {
    for (const PlannedNode& node : plan.nodes)
      is_needed_.push_back(node.required || (options.records && node.name == kRecorder));
    if (launch.clock == config::Clock::kRealtime) timers_.emplace();
    if (!options.signals_file.empty() || !options.summary_file.empty())
      signals_.emplace(participant_, options.signals_file, options.summary_file,
                       simulates(plan) ? first_epoch_ : 0);
    output_.say("session '" + launch.session + "' in DDS domain " +
                std::to_string(registration.domain()) +
                (network.is_loopback() ? "" : " on " + network.address) +
                (security.is_on() ? ", secured" : ""));
    const std::string warning =
        node::exposure_warning(network, registration.domain(), security.is_on());
    if (!warning.empty()) output_.say("warning: " + warning);
    for (const std::string& sentence : existing_takes(launch, plan)) output_.say(sentence);
  }

  void line(std::size_t process, Stream stream, std::string_view text) override {
    output_.line(process, stream, text);
  }

  void restarts(std::size_t process, const Ending& ending,
                std::chrono::milliseconds delay) override {
    take_statuses();
    is_down_[process] = true;
    const PlannedNode& node = plan_.nodes[process];
    board_.begin_life(node.name, static_cast<std::uint64_t>(node::monotonic_nsec()));
    output_.say(node.name + ": " + ending.text() + "; it starts again in " + in_seconds(delay) +
                " s" + loss_of(node));
  }

  std::vector<std::string> words_of_next_life(std::size_t process) override {
    take_statuses();  // the last one of a node may arrive after its end is seen
    const PlannedNode& node = plan_.nodes[process];
    const std::optional<bool> paused = board_.was_paused(node.name);
    if (node.program != "sim_node" || !paused) return {};
    return {node.name + (*paused ? ".paused=true" : ".paused=false")};
  }

  void restarted(std::size_t process) override {
    is_down_[process] = false;
    ++restarts_[process];
  }

  bool ended(std::size_t process, const Ending& ending, bool stopping) override {
    const PlannedNode& node = plan_.nodes[process];
    present_[process] = false;
    is_down_[process] = false;
    registration_.remove_node(node.name);
    const bool failed = ending.exit_code() != kSuccess;
    if (node.required && result_ == kSuccess) result_ = ending.exit_code();
    if (failed) failures_[process] = ending.text();
    if (stopping) {
      if (failed && !killed_[process]) output_.say(node.name + ": " + ending.text());
      return node.required;
    }
    output_.say(node.name + ": " + (failed ? ending.text() : "has ended") +
                why_not_again(node, ending) +
                (node.required ? "; stopping the others" : "; the others go on"));
    if (node.required) stop();
    if (failure_ == kSuccess) failure_ = ending.exit_code();
    return node.required;
  }

  void killed(std::size_t process) override {
    killed_[process] = true;
    output_.say(plan_.nodes[process].name + ": did not stop in time and is killed");
  }

  void interrupted(bool again) override {
    stop();
    output_.say(again ? "killing all nodes; devices have 0.5 s to let go"
                      : "stopping; once more kills");
  }

  bool tick() override {
    take_statuses();
    for (const std::string& sentence : others_.update(Clock::now())) output_.say(sentence);
    const std::string reason = machine_.sentence_when_repeated(board_.late_ticks());
    if (!reason.empty()) output_.say(reason);
    output_.flush();
    const bool over = plan_.wall_duration && is_over(*plan_.wall_duration);
    if (over && !stopped_) has_stood_still_ = is_standing_still();
    if (over) stop();
    return over;
  }

  /// Prints what is known at the end. @return the exit code of the run.
  int finish() {
    take_statuses();
    const std::vector<std::string> names = names_of(plan_);
    const bool is_reporting = std::any_of(names.begin(), names.end(), [this](const auto& name) {
      return board_.find(name) != nullptr;
    });
    if (is_reporting) {
      output_.print("");
      output_.print(status_table(names, board_));
      const std::string reason = machine_.sentence(board_.late_ticks());
      if (!reason.empty()) output_.print(reason);
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (restarts_[i] > 0)
        output_.print(names[i] + " was started again " + config::count_text(restarts_[i], "time"));
    }
    if (has_stood_still_) output_.print(kNoDevice);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (is_down_[i]) output_.print(names[i] + " was down at the end");
      if (is_lost(i)) has_lost_node_ = true;
    }
    if (has_lost_node_ && result_ == kSuccess) result_ = kFailure;
    if (has_lost_node_ && failure_ == kSuccess) failure_ = kFailure;
    if (signals_) {
      output_.print(signals_->finish(ends_of_nodes()));
      if (!signals_->is_whole() && result_ == kSuccess) result_ = kFailure;
      if (!signals_->is_whole() && failure_ == kSuccess) failure_ = kFailure;
    }
    return stopped_ ? result_ : failure_;
  }

 private:
  /// True if the last status of a node says so, whatever its process ended with.
  bool has_failed(const std::string& node) const {
    const msg::NodeStatus* status = board_.find(node);
    return status != nullptr && status->phase() == msg::PHASE_FAILED;
  }

  /// True if the run needs the node, and did not keep it to the end, or it waited in vain.
  bool is_lost(std::size_t process) const {
    const PlannedNode& node = plan_.nodes[process];
    const bool waited = has_stood_still_ && node.program == "sim_node";
    return is_needed_[process] &&
           (is_down_[process] || !failures_[process].empty() || waited || has_failed(node.name));
  }

  /// True if the scene has waited for its devices from the start, and none is to come: those of this launch
  /// are played by no port.
  bool is_standing_still() const {
    bool sim_waits = false;
    for (const PlannedNode& node : plan_.nodes) {
      const msg::NodeStatus* status = board_.find(node.name);
      const msg::NodePhase phase = status == nullptr ? msg::PHASE_STARTING : status->phase();
      if (node.program == "device_node" && phase != msg::PHASE_UNUSED) return false;
      sim_waits = sim_waits || (node.program == "sim_node" && phase == msg::PHASE_WAITING);
    }
    return sim_waits && !has_played_ && !has_devices_elsewhere_;
  }

  /// How each node stood at the end, for the summary.
  std::vector<NodeEnd> ends_of_nodes() const {
    std::vector<NodeEnd> ends;
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      const PlannedNode& node = plan_.nodes[i];
      const msg::NodeStatus* status = board_.find(node.name);
      NodeEnd& end = ends.emplace_back(NodeEnd{.name = node.name, .program = node.program});
      end.has_failed = is_lost(i);
      end.reason = is_down_[i] ? "was down at the end" : failures_[i];
      if (has_stood_still_ && node.program == "sim_node") end.reason = kNoDevice;
      if (!failures_[i].empty()) end.phase = node::word_of(msg::PHASE_FAILED);
      if (status == nullptr) continue;
      if (failures_[i].empty()) end.phase = node::word_of(status->phase());
      const bool is_device = status->kind() == msg::KIND_DEVICE_NODE;
      if (has_failed(node.name) || (is_device && node::has_ended(status->phase())))
        end.reason = status->text();
    }
    return ends;
  }

  /// What a node that starts again has lost, and what it keeps.
  std::string loss_of(const PlannedNode& node) const {
    if (node.program != "sim_node") return "";
    const std::optional<bool> was_paused = board_.was_paused(node.name);
    std::string text = " and begins at the start of the scene";
    if (was_paused) text += "; what `load` and `set` changed is lost";
    if (was_paused.value_or(false)) text += "; it was paused, and stays so until `resume`";
    return text;
  }

  void stop() {
    stopped_ = true;
    board_.begin_stop();
  }

  /// The reason why a node that may respawn is not started again; empty if there is none to state.
  static std::string why_not_again(const PlannedNode& node, const Ending& ending) {
    if (!node.respawn || ending.exit_code() == kSuccess) return "";
    if (ending.exit_code() == kBadInput) return " (bad input, which a restart does not mend)";
    return ", after " + std::to_string(RespawnPolicy::kMaxPerMinute) + " restarts in a minute";
  }

  void take_statuses() {
    msg::NodeStatus status;
    while (statuses_.take(status)) {
      const std::optional<std::string> news = others_.take(status, Clock::now());
      if (news && !stopped_) output_.say(*news);
      if (!is_planned(status.node())) continue;
      if (!statuses_.is_of_this_host()) {
        report_twin(status);
        continue;
      }
      if (!board_.put(status)) continue;
      if (status.kind() == msg::KIND_VIZ_NODE) show_page(status);
      has_played_ = has_played_ ||
                    (status.kind() == msg::KIND_SIM_NODE && status.phase() == msg::PHASE_RUNNING);
    }
  }

  /// On one host the registry of sessions refuses a node that runs already.
  void report_twin(const msg::NodeStatus& status) {
    if (node::has_ended(status.phase()) || !twins_.insert(status.node()).second) return;
    output_.say("warning: " + status.host() + " runs a node named '" + status.node() +
                "' as well: stop one of the two, or start each with --only");
  }

  bool is_planned(const std::string& node) const {
    return std::any_of(plan_.nodes.begin(), plan_.nodes.end(),
                       [&](const PlannedNode& planned) { return planned.name == node; });
  }

  /// What lets a page beyond loopback command, for a viz_node that this launcher has started; it is no
  /// part of the status, which others read.
  std::string token_for(const std::string& node, const std::string& page) const {
    const bool is_loopback = page.starts_with("http://127.") || page.starts_with("http://[::1]");
    const char* token = std::getenv("CORDIS_PAGE_TOKEN");
    if (is_loopback || token == nullptr || !is_planned(node)) return {};
    return std::string("/?token=") + token;
  }

  void show_page(const msg::NodeStatus& status) {
    std::string& shown = pages_[status.node()];
    const std::string page = status.text().substr(0, status.text().find(';'));
    if (!page.starts_with("http://") || page == shown) return;
    shown = page;
    output_.say("page of " + status.node() + ": " + shown + token_for(status.node(), page));
  }

  /// True if nothing more is to be waited for: a device that the scene does not play stays unused,
  /// and a scene without any other waits for no node of this launch.
  bool all_run() const {
    bool sim_waits = false;
    bool device_is_played = false;
    for (std::size_t i = 0; i < present_.size(); ++i) {
      if (!present_[i]) continue;
      const msg::NodeStatus* status = board_.find(plan_.nodes[i].name);
      if (status == nullptr) return false;
      const msg::NodePhase phase = status->phase();
      if (phase == msg::PHASE_UNUSED) continue;
      if (phase == msg::PHASE_WAITING && status->kind() == msg::KIND_SIM_NODE) {
        sim_waits = true;
        continue;
      }
      if (phase != msg::PHASE_RUNNING && phase != msg::PHASE_STANDBY) return false;
      device_is_played = device_is_played || status->kind() == msg::KIND_DEVICE_NODE;
    }
    return !(sim_waits && device_is_played);
  }

  bool is_over(std::chrono::nanoseconds duration) {
    const auto now = Clock::now();
    if (!counted_from_ && all_run()) counted_from_ = now;
    if (!counted_from_ && now >= started_ + kLongestStart) {
      output_.say("not all nodes run yet; the duration counts from now");
      counted_from_ = now;
    }
    return counted_from_ && now >= *counted_from_ + duration;
  }

  const RunPlan& plan_;
  node::SessionRegistration& registration_;
  NodeOutput output_;
  OtherNodes others_;
  std::uint64_t first_epoch_;  // nodes that this launcher starts begin later [ns]
  StatusBoard board_;
  std::optional<machine::TimerWatch> timers_;  // in realtime: elsewhere no tick is late
  MachineWatch machine_{[this] { return timers_ ? timers_->figures() : machine::TimerFigures{}; }};
  dds::Participant participant_;
  dds::Reader<msg::NodeStatus> statuses_;
  std::optional<SignalLog> signals_;
  std::map<std::string, std::string> pages_;  // address shown, by node
  std::set<std::string> twins_;               // nodes that another host runs as well
  std::vector<bool> present_;                 // runs, or starts again
  std::vector<bool> killed_;
  std::vector<bool> is_needed_;  // the run fails without it
  std::vector<std::uint64_t> restarts_;
  std::vector<bool> is_down_;          // waits to be started again
  std::vector<std::string> failures_;  // how a node ended that failed; else empty
  Clock::time_point started_;
  std::optional<Clock::time_point> counted_from_;
  bool has_devices_elsewhere_;    // of the launch file, which other launchers start
  bool has_played_ = false;       // the scene, with a device or without ports
  bool has_stood_still_ = false;  // until the duration was over
  bool stopped_ = false;          // a required node, the duration or a signal has ended the session
  int result_ = kSuccess;         // of the first required node that ended
  int failure_ = kSuccess;        // of the first node that failed
  bool has_lost_node_ = false;    // one that the run needs has failed, or was down at the end
};

}  // namespace

int run_session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options,
                node::SessionRegistration& registration, const dds::Network& network,
                const dds::Security& security, StopSignals& signals) {
  Session session(launch, plan, options, registration, network, security);
  std::vector<Command> commands;
  for (const PlannedNode& node : plan.nodes) {
    commands.push_back(node.command);
    commands.back().respawn = node.respawn;
  }
  supervise(commands, session, signals);
  return session.finish();
}

}  // namespace cordis::cli
