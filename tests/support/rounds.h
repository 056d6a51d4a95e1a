// tests/support/rounds.h -- how much of a long test is done where each step takes long.
#pragma once

namespace cordis::test {

/// How many of so many rounds a test does: all of them, but one in ten in debug builds and under sanitizers, which
/// check the first rounds as well as the last.
constexpr int rounds(int all) noexcept {
#ifdef CORDIS_ASSERTIONS
  return (all + 9) / 10;
#else
  return all;
#endif
}

/// From one seed to the next that a test tries. It is odd, so that kinds of scenes that alternate all come.
constexpr unsigned kSeedStride = rounds(9) == 9 ? 1 : 9;

}  // namespace cordis::test
