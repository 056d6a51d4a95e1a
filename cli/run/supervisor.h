// cli/run/supervisor.h -- runs a group of processes: starts them, reads their output, stops them in
// order.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "cli/run/child.h"
#include "cli/run/stop_signals.h"

namespace cordis::cli {

/// One process to run.
struct Command {
  std::vector<std::string> words;  ///< path of the program, then its arguments
  int stop_stage = 0;              ///< the smallest is stopped first
  bool drives_motors = false;      ///< it gets StopPlan::kLastFade to let go, whoever ends it
  bool writes_takes = false;       ///< it closes its take when the launcher is killed
  bool respawn = false;            ///< it starts again when it dies, as NodeLife says
};

/// Receives what happens to the processes, which are numbered as the commands were, and decides when
/// they stop.
class Watcher {
 public:
  virtual ~Watcher() = default;

  /// A line of output, without its newline.
  virtual void line(std::size_t process, Stream stream, std::string_view text) = 0;
  /// A process died, and starts again after `delay`.
  virtual void restarts(std::size_t /*process*/, const Ending& /*ending*/,
                        std::chrono::milliseconds /*delay*/) {}
  /// It starts again now. @return words that follow those of its command, for this life alone
  virtual std::vector<std::string> words_of_next_life(std::size_t /*process*/) { return {}; }
  /// It has been started again.
  virtual void restarted(std::size_t /*process*/) {}
  /// A process ended for good; `stopping` when all were to end anyway. @return whether the others
  /// are to stop now.
  virtual bool ended(std::size_t process, const Ending& ending, bool stopping) = 0;
  /// A process did not stop when asked, and is killed.
  virtual void killed(std::size_t process) = 0;
  /// A signal wants the end: all stop in order; at the second one they are killed at once, those
  /// that drive motors after StopPlan::kLastFade.
  virtual void interrupted(bool again) = 0;
  /// Called ten times a second, or more often. @return whether all are to stop now.
  virtual bool tick() = 0;
};

/// Starts the commands in their order and returns how each ended, once all have for good. Starts
/// those that die again by RespawnPolicy, where their command wants it. Stops them by StopPlan when
/// the watcher or a signal says so. The calling thread must be one that outlives the processes:
/// they are killed when it ends.
/// @throws std::runtime_error when a program cannot be started; those already started are killed.
std::vector<Ending> supervise(const std::vector<Command>& commands, Watcher& watcher,
                              StopSignals& signals);

}  // namespace cordis::cli
