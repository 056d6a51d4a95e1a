// cli/supervisor.cpp
#include "cli/supervisor.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <memory>
#include <optional>

#include <poll.h>
#include <unistd.h>

#include "cli/line_splitter.h"
#include "cli/stop_plan.h"

namespace cordis::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTick{100};
constexpr std::chrono::milliseconds kSameWish{300};  // timeout(1) sends its signal twice
constexpr std::array kStreams{Stream::kOut, Stream::kError};

struct Process {
  explicit Process(const Command& command) : child(command.words) {}
  Child child;
  std::array<LineSplitter, 2> lines;
  bool running = true;
  Ending ending;
};

class Supervision {
 public:
  Supervision(const std::vector<Command>& commands, Watcher& watcher, StopSignals& signals)
      : watcher_(watcher), signals_(signals), plan_(stages_of(commands)) {
    for (const Command& command : commands) {
      processes_.push_back(std::make_unique<Process>(command));
    }
  }

  std::vector<Ending> run() {
    while (any_running()) {
      wait();
      take_signals();
      for (std::size_t i = 0; i < processes_.size(); ++i) listen_to(i);
      for (std::size_t i = 0; i < processes_.size(); ++i) notice_end_of(i);
      if (watcher_.tick()) plan_.begin(Clock::now());
      follow_plan();
    }
    std::vector<Ending> endings;
    for (const auto& process : processes_) endings.push_back(process->ending);
    return endings;
  }

 private:
  static std::vector<int> stages_of(const std::vector<Command>& commands) {
    std::vector<int> stages;
    for (const Command& command : commands) stages.push_back(command.stop_stage);
    return stages;
  }

  bool any_running() const {
    return std::any_of(processes_.begin(), processes_.end(),
                       [](const auto& p) { return p->running; });
  }

  void wait() {
    std::vector<pollfd> files{{signals_.file(), POLLIN, 0}};
    for (const auto& process : processes_) {
      for (const Stream stream : kStreams)
        files.push_back({process->child.output(stream), POLLIN, 0});
    }
    auto until = Clock::now() + kTick;
    if (plan_.deadline()) until = std::min(until, *plan_.deadline());
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    poll(files.data(), files.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
  }

  void take_signals() {
    const auto now = Clock::now();
    if (!signals_.take() || (interrupted_ && now < *interrupted_ + kSameWish)) return;
    watcher_.interrupted(/*again=*/interrupted_.has_value());
    if (interrupted_) {
      for (const auto& process : processes_) process->child.kill();
    }
    interrupted_ = now;
    plan_.begin(now);
  }

  /// Reads what is there, but no endless flood: signals and the other processes have their turn.
  void listen_to(std::size_t index) {
    for (const Stream stream : kStreams) read_block(index, stream);
  }

  /// @return whether there may be more.
  bool read_block(std::size_t index, Stream stream) {
    Process& process = *processes_[index];
    std::array<char, 65536> block;
    const int file = process.child.output(stream);
    if (file < 0) return false;
    const ssize_t count = read(file, block.data(), block.size());
    const auto to_watcher = [&](std::string_view text) { watcher_.line(index, stream, text); };
    LineSplitter& lines = process.lines[static_cast<std::size_t>(stream)];
    if (count > 0) {
      lines.feed({block.data(), static_cast<std::size_t>(count)}, to_watcher);
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      lines.finish(to_watcher);
      process.child.close_output(stream);
    }
    return count > 0;
  }

  void notice_end_of(std::size_t index) {
    Process& process = *processes_[index];
    if (!process.running) return;
    const std::optional<Ending> ending = process.child.ending();
    if (!ending) return;
    process.running = false;
    process.ending = *ending;
    for (const Stream stream : kStreams) finish_output(index, stream);
    if (watcher_.ended(index, *ending, plan_.begun())) plan_.begin(Clock::now());
  }

  /// Reads what a process that has ended left in its pipe. A pipe holds a bounded amount, so this
  /// ends even when a process that escaped from the group goes on writing.
  void finish_output(std::size_t index, Stream stream) {
    constexpr int kBlocksOfAPipe =
        17;  // 1 MiB, the largest pipe an ordinary user may have, and one more
    for (int block = 0; block < kBlocksOfAPipe && read_block(index, stream); ++block) {
    }
    Process& process = *processes_[index];
    process.lines[static_cast<std::size_t>(stream)].finish(
        [&](std::string_view text) { watcher_.line(index, stream, text); });
    process.child.close_output(stream);
  }

  void follow_plan() {
    std::vector<bool> running;
    for (const auto& process : processes_) running.push_back(process->running);
    for (const auto& [index, kill] : plan_.due(Clock::now(), running)) {
      Child& child = processes_[index]->child;
      if (kill) {
        watcher_.killed(index);
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
  std::vector<std::unique_ptr<Process>> processes_;
};

}  // namespace

std::vector<Ending> supervise(const std::vector<Command>& commands, Watcher& watcher,
                              StopSignals& signals) {
  return Supervision(commands, watcher, signals).run();
}

}  // namespace cordis::cli
