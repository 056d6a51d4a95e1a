// sim_node/run/request.cpp
#include "sim_node/run/request.h"

namespace cordis::sim {
namespace {

constexpr auto kEndPollPeriod = std::chrono::milliseconds(20);

}  // namespace

bool RequestMailbox::submit(Request& request) noexcept {
  slot_.store(&request, std::memory_order_release);
  submitted_.release();
  while (!done_.try_acquire_for(kEndPollPeriod)) {
    if (!is_closed()) continue;
    // The loop closes the mailbox after its last request, so whatever was executed shows by now.
    const bool was_executed = done_.try_acquire();
    slot_.store(nullptr, std::memory_order_release);
    return was_executed;
  }
  return true;
}

void RequestMailbox::executed() noexcept {
  slot_.store(nullptr, std::memory_order_release);
  // May fail now and then, which costs one empty wait().
  static_cast<void>(submitted_.try_acquire());
  done_.release();
}

void RequestMailbox::wait(std::chrono::milliseconds at_most) noexcept {
  static_cast<void>(submitted_.try_acquire_for(at_most));
}

}  // namespace cordis::sim
