// cli/run/node_check.cpp
#include "cli/run/node_check.h"

#include <chrono>
#include <cstdio>

#include "cli/exit_code.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

constexpr std::chrono::seconds kLongestCheck{30};

class CheckWatcher : public Watcher {
 public:
  explicit CheckWatcher(std::size_t count)
      : outputs_(count), deadline_(std::chrono::steady_clock::now() + kLongestCheck) {}

  void line(std::size_t process, Stream /*stream*/, std::string_view text) override {
    (outputs_[process] += text) += '\n';
  }
  bool ended(std::size_t /*process*/, const Ending& /*ending*/, bool /*stopping*/) override {
    return false;
  }
  void killed(std::size_t /*process*/) override {}
  void interrupted(bool /*again*/) override { interrupted_ = true; }
  bool tick() override {
    late_ = late_ || std::chrono::steady_clock::now() > deadline_;
    return late_;
  }

  const std::string& output(std::size_t process) const { return outputs_[process]; }
  bool interrupted() const noexcept { return interrupted_; }
  bool late() const noexcept { return late_; }

 private:
  std::vector<std::string> outputs_;
  std::chrono::steady_clock::time_point deadline_;
  bool interrupted_ = false;
  bool late_ = false;
};

}  // namespace

std::optional<int> check_nodes(const RunPlan& plan, StopSignals& signals) {
  std::vector<Command> commands;
  for (const PlannedNode& node : plan.nodes) {
    commands.push_back(node.command);
    commands.back().words.emplace_back("--check");
  }
  CheckWatcher watcher(commands.size());
  const std::vector<Ending> endings = supervise(commands, watcher, signals);
  if (watcher.interrupted()) return kSuccess;

  std::optional<int> result;
  if (watcher.late()) {
    std::fputs("cordis: the nodes check their files for too long\n", stderr);
    result = kFailure;
  }
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (endings[i].exit_code() == kSuccess) continue;
    node::print_text(stderr, watcher.output(i));
    if (endings[i].exit_code() == kBadInput) {
      result = result.value_or(kBadInput);
    } else {
      result = kFailure;
      std::fprintf(stderr, "cordis: %s could not check its files: %s\n", plan.nodes[i].name.c_str(),
                   endings[i].text().c_str());
    }
  }
  return result;
}

}  // namespace cordis::cli
