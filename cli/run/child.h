// cli/run/child.h -- one process that the launcher started.
#pragma once

#include <array>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace cordis::cli {

/// How a process ended.
struct Ending {
  int code = 0;          ///< exit code, when `signal` is 0
  int signal = 0;        ///< the signal that killed it
  std::string reason{};  ///< why it could not be started; empty when it was

  int exit_code() const noexcept { return signal != 0 ? 128 + signal : code; }
  /// "exit code 1", "killed by signal 9 (Killed)", "cannot start sim_node: Permission denied"
  std::string text() const;
};

/// The two streams of output of a process.
enum class Stream { kOut, kError };
inline constexpr std::array kStreams{Stream::kOut, Stream::kError};

/// A process in a process group of its own, so that a Ctrl-C at the terminal reaches the launcher
/// alone, and the processes it starts itself can be ended with it. Every signal has its default
/// meaning in it, its standard input is empty, and it gets a signal when the launcher dies in
/// whatever way.
class Child {
 public:
  /// Starts `words[0]` with the rest as arguments.
  /// @param orphan_signal  is sent to it when the launcher dies: SIGKILL, or SIGTERM for a process
  ///                       that must let go of motors first and then ends by itself
  /// @throws std::runtime_error when the program cannot be started.
  explicit Child(const std::vector<std::string>& words, int orphan_signal = SIGKILL);

  /// Kills the whole group if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Its output: reading never blocks.
  int output(Stream stream) const noexcept { return output_[static_cast<std::size_t>(stream)]; }
  /// No more is read from this stream.
  void close_output(Stream stream) noexcept;

  /// Sends SIGTERM to the process itself: what it started is its own to end.
  void ask_to_stop() noexcept;
  /// Sends SIGKILL to the process and all of its group.
  void kill() noexcept;

  /// How it ended, once it has; what is left of its group is killed then. Never blocks. An end by
  /// the SIGTERM that ask_to_stop() sent counts as exit code 0.
  std::optional<Ending> ending() noexcept;

 private:
  pid_t id_ = -1;
  std::array<int, 2> output_{-1, -1};
  bool asked_ = false;
  std::optional<Ending> ending_;
};

}  // namespace cordis::cli
