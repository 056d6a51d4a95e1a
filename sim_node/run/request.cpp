// sim_node/run/request.cpp
#include "sim_node/run/request.h"

namespace cordis::sim {
namespace {

constexpr auto kLookForTheEnd = std::chrono::milliseconds(20);

}  // namespace

bool RequestMailbox::give(Request& order) noexcept {
  slot_.store(&order, std::memory_order_release);
  given_.release();
  while (!done_.try_acquire_for(kLookForTheEnd)) {
    if (!is_closed()) continue;
    // The loop closes the box after its last order, so whatever was obeyed shows by now.
    const bool was_obeyed = done_.try_acquire();
    slot_.store(nullptr, std::memory_order_release);
    return was_obeyed;
  }
  return true;
}

void RequestMailbox::obeyed() noexcept {
  slot_.store(nullptr, std::memory_order_release);
  // May fail now and then, which costs one empty wait().
  static_cast<void>(given_.try_acquire());
  done_.release();
}

void RequestMailbox::wait(std::chrono::milliseconds at_most) noexcept {
  static_cast<void>(given_.try_acquire_for(at_most));
}

}  // namespace cordis::sim
