// cli/run/supervisor.cpp
#include "cli/run/supervisor.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>

#include <poll.h>

#include "cli/run/node_life.h"
#include "cli/run/stop_plan.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTick{100};
constexpr std::chrono::milliseconds kSameTarget{300};  // timeout(1) sends its signal twice

class Supervision {
 public:
  Supervision(const std::vector<Command>& commands, Watcher& watcher, StopSignals& signals)
      : watcher_(watcher), signals_(signals), plan_(stages_of(commands), motors_of(commands)) {
    for (const Command& command : commands) {
      const auto sink = [this, index = lives_.size()](Stream stream, std::string_view text) {
        watcher_.line(index, stream, text);
      };
      const int orphan_signal = command.drives_motors || command.writes_takes ? SIGTERM : SIGKILL;
      lives_.push_back(
          std::make_unique<NodeLife>(command.words, command.respawn, orphan_signal, sink));
    }
  }

  std::vector<Ending> run() {
    while (!all_over()) {
      wait();
      take_signals();
      for (const auto& life : lives_) life->read_output();
      for (std::size_t i = 0; i < lives_.size(); ++i) take_end_of(i);
      if (watcher_.tick()) plan_.begin(Clock::now());
      restart_who_is_due();
      follow_plan();
    }
    std::vector<Ending> endings;
    for (const auto& life : lives_) endings.push_back(life->ending());
    return endings;
  }

 private:
  static std::vector<int> stages_of(const std::vector<Command>& commands) {
    std::vector<int> stages;
    for (const Command& command : commands) stages.push_back(command.stop_stage);
    return stages;
  }

  static std::vector<bool> motors_of(const std::vector<Command>& commands) {
    std::vector<bool> motors;
    for (const Command& command : commands) motors.push_back(command.drives_motors);
    return motors;
  }

  bool all_over() const {
    return std::all_of(lives_.begin(), lives_.end(), [](const auto& life) { return life->over(); });
  }

  void wait() {
    std::vector<pollfd> files{{signals_.file(), POLLIN, 0}};
    auto until = Clock::now() + kTick;
    for (const auto& life : lives_) {
      for (const Stream stream : kStreams) files.push_back({life->output(stream), POLLIN, 0});
      if (life->restart_at()) until = std::min(until, *life->restart_at());
    }
    if (plan_.deadline()) until = std::min(until, *plan_.deadline());
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    poll(files.data(), files.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
  }

  void take_signals() {
    const auto now = Clock::now();
    if (!signals_.take() || (interrupted_ && now < *interrupted_ + kSameTarget)) return;
    watcher_.interrupted(/*again=*/interrupted_.has_value());
    if (interrupted_) plan_.hurry(now);
    interrupted_ = now;
    plan_.begin(now);
  }

  void take_end_of(std::size_t index) {
    const auto now = Clock::now();
    if (lives_[index]->take_end(now, plan_.begun())) report_end_of(index, now);
  }

  void report_end_of(std::size_t index, Clock::time_point now) {
    const NodeLife& life = *lives_[index];
    if (life.restart_at()) {
      const auto delay = *life.restart_at() - now;
      watcher_.restarts(index, life.ending(), std::chrono::round<std::chrono::milliseconds>(delay));
    } else if (watcher_.ended(index, life.ending(), plan_.begun())) {
      plan_.begin(now);
    }
  }

  /// No process starts again once all are to stop.
  void restart_who_is_due() {
    const auto now = Clock::now();
    for (std::size_t i = 0; i < lives_.size(); ++i) {
      NodeLife& life = *lives_[i];
      if (plan_.begun()) life.cancel_restart();
      if (!life.restart_at() || now < *life.restart_at()) continue;
      if (life.restart(now, watcher_.words_of_next_life(i))) {
        watcher_.restarted(i);
      } else {
        report_end_of(i, now);
      }
    }
  }

  void follow_plan() {
    std::vector<bool> running;
    for (const auto& life : lives_) running.push_back(life->running());
    for (const auto& [index, kill] : plan_.due(Clock::now(), running)) {
      Child& child = *lives_[index]->child();
      if (kill) {
        if (!plan_.hurried()) watcher_.killed(index);
        child.kill();
      } else {
        child.ask_to_stop();
      }
    }
  }

  Watcher& watcher_;
  StopSignals& signals_;
  StopPlan plan_;
  std::optional<Clock::time_point> interrupted_;
  std::vector<std::unique_ptr<NodeLife>> lives_;
};

}  // namespace

std::vector<Ending> supervise(const std::vector<Command>& commands, Watcher& watcher,
                              StopSignals& signals) {
  return Supervision(commands, watcher, signals).run();
}

}  // namespace cordis::cli
