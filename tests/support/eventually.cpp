// tests/support/eventually.cpp
#include "tests/support/eventually.h"

#include <cstdio>
#include <thread>

namespace cordis::test {

bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds at_most) {
  const auto limit = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > limit) {
      std::fprintf(stderr, "a condition did not hold within %.3g s\n",
                   std::chrono::duration<double>(at_most).count());
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace cordis::test
