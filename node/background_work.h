// node/background_work.h -- long work in a thread of its own that no end of the process waits for.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <utility>

namespace cordis::node {

/// Does @p work in a thread of its own. Who has no more use for the result drops the future, and
/// waits for nothing; so the work owns all that it uses.
/// @returns the result, or what the work has thrown
template <typename Result>
std::future<Result> start_background_work(std::function<Result()> work);

/// True while the thread of some work lives.
bool background_work_is_under_way() noexcept;

/// Ends the process with an exit code, as return from main does. While background work is under way
/// it ends at once after the log is written, for that work may use what a return from main
/// destroys.
[[nodiscard]] int leave_with(int exit_code);

namespace detail {

void run_detached(std::function<void()> work);

}  // namespace detail

template <typename Result>
std::future<Result> start_background_work(std::function<Result()> work) {
  auto task = std::make_shared<std::packaged_task<Result()>>(std::move(work));
  std::future<Result> result = task->get_future();
  detail::run_detached([task] { (*task)(); });
  return result;
}

}  // namespace cordis::node
