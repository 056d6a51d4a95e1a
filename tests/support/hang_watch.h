// tests/support/hang_watch.h -- ends a test that hangs, with the output of its processes.
#pragma once

#include <chrono>

namespace cordis::test {

class ChildProcess;

/// So long may a test take that starts processes; then the program is aborted, and every process of
/// it is printed. CTest would end it later, and without a word.
/// CORDIS_TEST_LIMIT_S of the environment sets another limit [s].
inline constexpr std::chrono::minutes kTestLimit{10};

/// Adds a process to those that are printed.
void watch(const ChildProcess* process);
/// Takes it off.
void forget(const ChildProcess* process);

}  // namespace cordis::test
