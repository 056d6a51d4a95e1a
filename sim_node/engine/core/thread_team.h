// sim_node/engine/core/thread_team.h -- threads that share the loops of a step.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace cordis::engine {

/// A fixed team of threads: the one that calls, and others that wait for it.
///
/// Who waits polls for some 50 us, so that the threads of steps that follow one another stay awake,
/// then sleeps. A team of more members than the machine has cores sleeps at once. A team serves one
/// caller at a time. Its members have the floating-point mode of FloatMode and take no signals.
class ThreadTeam {
 public:
  /// Threads for which a step is laid out: larger teams share no sets.
  static constexpr std::size_t kMaxMembers = 256;

  /// @param member_count  threads, the caller included. Precondition: at least 1.
  /// @throws std::system_error when the system gives no more threads
  explicit ThreadTeam(std::size_t member_count);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  std::size_t member_count() const noexcept { return others_.size() + 1; }

  /// Calls task(member) once for each member at the same time, 0 on the calling thread, and returns when
  /// all have ended. Real time: no allocation; some 0.3 us on cores that are awake.
  template <class Task>
  void run(const Task& task) noexcept {
    if (others_.empty()) {
      task(std::size_t{0});
      return;
    }
    begin([](const void* of, std::size_t member) { (*static_cast<const Task*>(of))(member); },
          &task);
    task(std::size_t{0});
    await_others();
  }

  /// Within a task: returns when all members have called it. Real time: as run().
  void meet() noexcept;

  /// The part [first, last) of `count` things that a member takes: all parts are neighbours, and as
  /// large as can be.
  struct Share {
    std::size_t first;
    std::size_t last;
  };
  Share share(std::size_t member, std::size_t count) const noexcept {
    return part_of(member, member_count(), count);
  }
  /// Likewise of so many parts.
  static Share part_of(std::size_t part, std::size_t parts, std::size_t count) noexcept {
    return {part * count / parts, (part + 1) * count / parts};
  }

 private:
  using Call = void (*)(const void* task, std::size_t member);

  void begin(Call call, const void* task) noexcept;
  void await_others() noexcept;
  void end() noexcept;
  void serve(std::size_t member) noexcept;

  static constexpr std::size_t kCacheLine = 64;

  Call call_ = nullptr;
  const void* task_ = nullptr;
  bool ends_ = false;
  int polls_ = 0;
  alignas(kCacheLine) std::atomic<std::uint32_t> task_number_{0};
  alignas(kCacheLine) std::atomic<std::uint32_t> working_{0};  // other members that have not ended
  alignas(kCacheLine) std::atomic<std::uint32_t> arrived_{0};  // at the meeting
  alignas(kCacheLine) std::atomic<std::uint32_t> meetings_{0};
  std::vector<std::jthread> others_;
};

}  // namespace cordis::engine
