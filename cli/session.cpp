// cli/session.cpp
#include "cli/session.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "cli/exit_code.h"
#include "cli/node_output.h"
#include "cli/status_board.h"
#include "node/dds/reader.h"
#include "node/time.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLongestStart{5};

std::vector<std::string> names_of(const RunPlan& plan) {
  std::vector<std::string> names;
  for (const PlannedNode& node : plan.nodes) names.push_back(node.name);
  return names;
}

class Session : public Watcher {
 public:
  Session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options)
      : plan_(plan),
        output_(names_of(plan), options.log_directory, options.no_color),
        board_(static_cast<std::uint64_t>(node::monotonic_nsec())),
        participant_(
            {launch.domain, launch.session, "cordis", launch.clock == config::Clock::kLockstep}),
        statuses_(participant_, dds::Topic::kStatus),
        present_(plan.nodes.size(), true),
        killed_(plan.nodes.size(), false),
        started_(Clock::now()) {}

  void line(std::size_t process, Stream stream, std::string_view text) override {
    output_.line(process, stream, text);
  }

  bool ended(std::size_t process, const Ending& ending, bool stopping) override {
    const PlannedNode& node = plan_.nodes[process];
    present_[process] = false;
    const bool failed = ending.exit_code() != kSuccess;
    if (node.required && result_ == kSuccess) result_ = ending.exit_code();
    if (stopping) {
      if (failed && !killed_[process]) output_.say(node.name + ": " + ending.text());
    } else {
      output_.say(node.name + ": " + (failed ? ending.text() : "has ended") +
                  (node.required ? "; stopping the others" : "; the others go on"));
    }
    return node.required;
  }

  void killed(std::size_t process) override {
    killed_[process] = true;
    output_.say(plan_.nodes[process].name + ": did not stop in time and is killed");
  }

  void interrupted(bool again) override {
    output_.say(again ? "killing all nodes" : "stopping; once more kills");
  }

  bool tick() override {
    take_statuses();
    output_.flush();
    return plan_.wall_duration && is_over(*plan_.wall_duration);
  }

  /// Prints what is known at the end. @return the exit code of the run.
  int finish() {
    take_statuses();
    const std::vector<std::string> names = names_of(plan_);
    const bool heard = std::any_of(names.begin(), names.end(), [this](const auto& name) {
      return board_.find(name) != nullptr;
    });
    if (heard) {
      output_.print("");
      output_.print(status_table(names, board_));
    }
    return result_;
  }

 private:
  void take_statuses() {
    msg::NodeStatus status;
    while (statuses_.take(status)) {
      if (board_.put(status) && status.kind() == "viz_node") show_page(status);
    }
  }

  void show_page(const msg::NodeStatus& status) {
    std::string& shown = pages_[status.node()];
    if (!status.text().starts_with("http://") || status.text() == shown) return;
    shown = status.text();
    output_.say("page of " + status.node() + ": " + shown);
  }

  /// Whether nothing more is to be waited for: a device that the scene does not play stays unused,
  /// and a scene without any other waits for nobody of this launch.
  bool all_run() const {
    bool sim_waits = false;
    bool device_is_played = false;
    for (std::size_t i = 0; i < present_.size(); ++i) {
      if (!present_[i]) continue;
      const msg::NodeStatus* status = board_.find(plan_.nodes[i].name);
      if (status == nullptr) return false;
      const std::string& phase = status->phase();
      if (phase == "unused") continue;
      if (phase == "waiting" && status->kind() == "sim_node") {
        sim_waits = true;
        continue;
      }
      if (phase != "running" && phase != "standby") return false;
      device_is_played = device_is_played || status->kind() == "device_node";
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
  NodeOutput output_;
  StatusBoard board_;
  dds::Participant participant_;
  dds::Reader<msg::NodeStatus> statuses_;
  std::map<std::string, std::string> pages_;  // address shown, by node
  std::vector<bool> present_;
  std::vector<bool> killed_;
  Clock::time_point started_;
  std::optional<Clock::time_point> counted_from_;
  int result_ = kSuccess;
};

}  // namespace

int run_session(const config::Launch& launch, const RunPlan& plan, const RunOptions& options,
                StopSignals& signals) {
  Session session(launch, plan, options);
  std::vector<Command> commands;
  for (const PlannedNode& node : plan.nodes) commands.push_back(node.command);
  supervise(commands, session, signals);
  return session.finish();
}

}  // namespace cordis::cli
