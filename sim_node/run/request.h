// sim_node/run/request.h -- what another thread wants of the loop, and how it gets there.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <semaphore>
#include <vector>

#include "sim_node/run/loaded_scene.h"
#include "sim_node/run/request_source.h"

namespace cordis::sim {

/// Something to be done between two steps. All that costs time has been done when it is submitted,
/// and what is to be freed goes back to the thread that submitted it.
struct Request {
  enum class Kind : std::uint8_t {
    kPause,
    kResume,
    kStep,        ///< pause, then do `steps` steps
    kRestart,     ///< play `scene` from its beginning
    kExchange,    ///< go on in `scene`, the same one with other parameters
    kForceStates  ///< put links into states
  };
  struct ForcedState {
    std::uint32_t link;  ///< index of a link with states, or of a bend
    std::uint32_t state;
    bool is_bend = false;
  };
  Kind kind = Kind::kPause;
  std::uint64_t steps = 0;
  std::unique_ptr<LoadedScene> scene;  ///< the new one; afterwards the one played before
  std::vector<double> room;            ///< kExchange: room for max_values_of_state() of its world
  std::vector<ForcedState> forced;
  std::shared_ptr<const RequestSource> source;  ///< the command that it comes from

  bool changes_scene() const noexcept { return kind == Kind::kRestart || kind == Kind::kExchange; }

  // What the loop has to say about it.
  std::uint64_t step = 0;           ///< steps done when it was executed, in the scene played then
  bool was_paused = false;          ///< before
  std::uint64_t steps_dropped = 0;  ///< kPause: single steps that were still to be done
  bool done = true;                 ///< false: kExchange found that the scene does not fit
};

/// Room for one request on its way from one thread to the loop.
class RequestMailbox {
 public:
  /// Submits a request and waits until it was executed. One thread at a time.
  /// @return false when the loop has ended, and the request was not executed
  [[nodiscard]] bool submit(Request& request) noexcept;

  /// Loop: the request that waits, or nullptr. Real time: takes no lock.
  Request* waiting() const noexcept { return slot_.load(std::memory_order_acquire); }
  /// Loop: the waiting request was executed. Real time: wakes the other thread, waits for nothing.
  void executed() noexcept;
  /// Loop without real time: waits for a request, at most so long.
  void wait(std::chrono::milliseconds at_most) noexcept;
  /// Single steps still to be done after the last kStep; any thread.
  std::uint64_t steps_left() const noexcept { return steps_left_.load(std::memory_order_acquire); }
  /// Loop: publishes that count.
  void report_steps_left(std::uint64_t count) noexcept {
    steps_left_.store(count, std::memory_order_release);
  }
  /// True if close() was called; any thread.
  bool is_closed() const noexcept { return closed_.load(std::memory_order_acquire); }
  /// Loop: no request will be executed any more.
  void close() noexcept { closed_.store(true, std::memory_order_release); }

 private:
  std::atomic<Request*> slot_{nullptr};
  std::atomic<std::uint64_t> steps_left_{0};
  std::atomic<bool> closed_{false};
  std::counting_semaphore<> submitted_{0};
  std::binary_semaphore done_{0};
};

}  // namespace cordis::sim
