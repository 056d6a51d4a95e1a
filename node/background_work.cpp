// node/background_work.cpp
#include "node/background_work.h"

#include <atomic>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

namespace cordis::node {
namespace {

std::atomic<int> under_way{0};

}  // namespace

bool background_work_is_under_way() noexcept {
  return under_way > 0;
}

int leave_with(int exit_code) {
  if (!background_work_is_under_way()) return exit_code;
  spdlog::default_logger()->flush();
  _exit(exit_code);
}

namespace detail {

void run_detached(std::function<void()> work) {
  ++under_way;
  try {
    std::thread([work = std::move(work)]() mutable {
      work();
      work = nullptr;  // what it owns ends before the count does
      --under_way;
    }).detach();
  } catch (...) {
    --under_way;
    throw;
  }
}

}  // namespace detail
}  // namespace cordis::node
