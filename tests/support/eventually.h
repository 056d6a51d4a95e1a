// tests/support/eventually.h -- the one way in which a test waits for a condition.
#pragma once

#include <chrono>
#include <functional>

namespace cordis::test {

/// The limit of every wait, for conditions that hold after a fraction of a second on a free
/// machine. Only a test that fails waits for so long.
inline constexpr std::chrono::seconds kPatience{120};

/// Waits until `condition` holds, and asks it again every 2 ms. Tests never sleep for a fixed time.
/// @return false when kPatience ends first; the output says so
bool eventually(const std::function<bool()>& condition,
                std::chrono::milliseconds at_most = kPatience);

}  // namespace cordis::test
