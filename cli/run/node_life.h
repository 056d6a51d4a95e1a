// cli/run/node_life.h -- one process of a group, from its first start to its last end.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/run/child.h"
#include "cli/run/line_splitter.h"
#include "cli/run/respawn_policy.h"

namespace cordis::cli {

/// A process that runs, waits to be started again, or is over for good. It starts again when it
/// dies: when a signal kills it, or when it ends with an exit code other than 0 (done) and 2 (bad
/// input).
class NodeLife {
 public:
  using Time = RespawnPolicy::Time;
  using LineSink = std::function<void(Stream, std::string_view)>;

  /// Starts it. @param words  path of the program, then its arguments
  /// @param respawn  whether it starts again when it dies
  /// @param orphan_signal  as Child has it
  /// @throws std::runtime_error when the program cannot be started.
  NodeLife(std::vector<std::string> words, bool respawn, int orphan_signal, LineSink sink);
  NodeLife(const NodeLife&) = delete;
  NodeLife& operator=(const NodeLife&) = delete;

  bool running() const noexcept { return child_ != nullptr; }
  /// When it starts again; nothing while it runs and when it is over.
  std::optional<Time> restart_at() const noexcept { return restart_at_; }
  bool over() const noexcept { return !child_ && !restart_at_; }
  /// How its latest process ended, once one has.
  const Ending& ending() const noexcept { return ending_; }

  /// The process that runs; nullptr when none does.
  Child* child() noexcept { return child_.get(); }
  /// The output of the running process; -1 when none runs.
  int output(Stream stream) const noexcept { return child_ ? child_->output(stream) : -1; }

  /// Hands on what the process wrote, but no endless flood: others have their turn.
  void read_output();
  /// Looks whether the process has ended. @param stopping  whether all are to end: then it does not
  /// start again
  /// @return true once per end; restart_at() reports whether it starts again.
  bool take_end(Time now, bool stopping);
  /// Starts the process again. @param more_words  stand behind the arguments, this time alone
  /// @return true when it runs; else take_end()'s rules hold for the
  /// failed start, and restart_at() and ending() report what follows.
  bool restart(Time now, const std::vector<std::string>& more_words);
  /// A process that waits to be started again is over.
  void cancel_restart() noexcept { restart_at_.reset(); }

 private:
  bool read_block(Stream stream);
  void finish_output(Stream stream);
  void end_with(const Ending& ending, Time now, bool stopping);

  std::vector<std::string> words_;
  bool respawn_;
  int orphan_signal_;
  LineSink sink_;
  std::unique_ptr<Child> child_;
  std::array<LineSplitter, 2> lines_;
  RespawnPolicy policy_;
  std::optional<Time> restart_at_;
  Ending ending_;
};

}  // namespace cordis::cli
