// cli/run/stop_signals.h -- the request of a person, or of the system, that a run ends.
#pragma once

#include <csignal>

namespace cordis::cli {

/// As long as it lives, SIGINT, SIGTERM and SIGHUP do not end this process but wait here to be
/// taken, together with SIGCHLD. SIGINT counts even when the invoking shell ignored it (a command
/// started with &); SIGHUP stays ignored when it was (nohup). Make it before the first other
/// thread, and once per process at a time.
class StopSignals {
 public:
  /// @throws std::runtime_error when the system refuses.
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// For poll(): readable when a signal waits.
  int file() const noexcept { return file_; }

  /// Takes all that wait. @return whether one of them was a request to stop.
  bool take() noexcept;

 private:
  sigset_t before_;
  void (*interrupt_before_)(int);
  int file_;
};

}  // namespace cordis::cli
