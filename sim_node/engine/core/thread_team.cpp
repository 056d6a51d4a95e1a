// sim_node/engine/core/thread_team.cpp
#include "sim_node/engine/core/thread_team.h"

#include <immintrin.h>
#include <signal.h>

#include "node/assert.h"
#include "sim_node/engine/core/float_mode.h"

namespace cordis::engine {
namespace {

/// Keeps signals from the threads that are made while it lives: they belong to those that wait for them.
class BlockedSignals {
 public:
  BlockedSignals() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

/// Returns when the value is another one.
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t from, int polls) noexcept {
  for (int poll = 0; poll < polls; ++poll) {
    if (value.load(std::memory_order_acquire) != from) return;
    _mm_pause();
  }
  value.wait(from, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(std::size_t member_count) {
  CORDIS_ASSERT(member_count > 0);
  constexpr int kPolls = 1000;  // some 50 us
  polls_ = member_count <= std::thread::hardware_concurrency() ? kPolls : 0;
  const BlockedSignals blocked;
  others_.reserve(member_count - 1);
  try {
    for (std::size_t member = 1; member < member_count; ++member) {
      others_.emplace_back([this, member] { serve(member); });
    }
  } catch (...) {
    end();
    throw;
  }
}

ThreadTeam::~ThreadTeam() {
  end();
}

void ThreadTeam::end() noexcept {
  ends_ = true;
  task_number_.fetch_add(1, std::memory_order_release);
  task_number_.notify_all();
  others_.clear();
}

void ThreadTeam::begin(Call call, const void* task) noexcept {
  call_ = call;
  task_ = task;
  working_.store(static_cast<std::uint32_t>(others_.size()), std::memory_order_relaxed);
  task_number_.fetch_add(1, std::memory_order_release);
  task_number_.notify_all();
}

void ThreadTeam::await_others() noexcept {
  for (std::uint32_t working = working_.load(std::memory_order_acquire); working > 0;
       working = working_.load(std::memory_order_acquire)) {
    await_change(working_, working, polls_);
  }
}

void ThreadTeam::meet() noexcept {
  if (others_.empty()) return;
  const std::uint32_t meeting = meetings_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < member_count()) {
    await_change(meetings_, meeting, polls_);
    return;
  }
  arrived_.store(0, std::memory_order_relaxed);
  meetings_.fetch_add(1, std::memory_order_release);
  meetings_.notify_all();
}

void ThreadTeam::serve(std::size_t member) noexcept {
  const FloatMode mode;
  for (std::uint32_t number = 0;; ++number) {
    await_change(task_number_, number, polls_);
    if (ends_) return;
    call_(task_, member);
    if (working_.fetch_sub(1, std::memory_order_acq_rel) == 1) working_.notify_all();
  }
}

}  // namespace cordis::engine
