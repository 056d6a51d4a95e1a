// device_node/drivers/guardian.h -- a process of its own that takes the force from the motors of a
// real device when this process cannot.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <sys/types.h>

#include "device_node/drivers/motor_release.h"
#include "node/repeated_event.h"

namespace cordis::device {

/// The guardian holds a duplicate of the device's descriptor and its release frame. It writes the
/// frame when this process has ended in whatever way, SIGKILL included, and when a force stands for
/// longer than the stall limit because this process is stopped. It is in a session and group of its
/// own, and blocks all signals; it ends as soon as this process has.
///
/// One per process, for one device.
class Guardian {
 public:
  /// Starts it, and installs the release at a crash.
  /// @param stall_limit  age of a force at which the loop counts as stalled, > 0
  /// @throws std::runtime_error when it cannot be started.
  explicit Guardian(std::chrono::nanoseconds stall_limit);

  /// Ends it, and waits for its end.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// The guardian of this process; nullptr if there is none.
  static Guardian* of_process() noexcept;

  /// Holds the descriptor of the device, in place of the one before.
  void hold(int file, const ReleaseFrame& frame) noexcept;
  /// Gives it back. Call before the descriptor is closed.
  void drop() noexcept;

  /// Records that a frame has been written. @param any_force  some motor is given a force
  void record_frame(bool any_force) noexcept;

  /// How often it has taken the force because the loop stalled.
  std::uint32_t release_count() const noexcept;

  /// Starts it again if it has ended, and logs that. It tries at each call until that succeeds.
  /// Cheap: a system call.
  void watch() noexcept;

 private:
  struct Shared {
    std::atomic<std::int64_t> driven_nsec{0};  // when a force was written last; 0: there is none
    std::atomic<std::uint32_t> releases{0};
  };
  class Life;

  [[nodiscard]] bool start() noexcept;
  void send(int file) noexcept;
  bool has_ended() noexcept;

  Shared* shared_ = nullptr;
  std::chrono::nanoseconds stall_limit_;
  pid_t id_ = -1;
  int socket_ = -1;
  int file_ = -1;
  ReleaseFrame frame_;
  node::RepeatedEvent restarts_{"the guardian process of the motors was killed and started again"};
  node::RepeatedEvent failures_{"the guardian process of the motors still cannot be started again",
                                spdlog::level::err};
};

}  // namespace cordis::device
