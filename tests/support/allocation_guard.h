// tests/support/allocation_guard.h -- counts what a piece of code allocates.
#pragma once

#include <cstddef>

namespace cordis::test {

/// Counts the calls of operator new made by this thread since its construction.
/// A program that uses it is linked with tests/support/allocation_guard.cpp, which replaces
/// operator new.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;

  std::size_t count() const noexcept;

 private:
  std::size_t before_;
};

}  // namespace cordis::test
