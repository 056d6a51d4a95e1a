// tests/support/rounds.h -- how much of a long test is done under sanitizers.
#pragma once

namespace cordis::test {

/// How many of so many rounds a test does: all of them, but one in ten where a sanitizer watches
/// every access, which it does in the first rounds as well as in the last.
constexpr int rounds(int all) noexcept {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (all + 9) / 10;
#else
  return all;
#endif
}

/// From one seed to the next that a test tries. It is odd, so that kinds of scenes that alternate all come.
constexpr unsigned kSeedStride = rounds(9) == 9 ? 1 : 9;

}  // namespace cordis::test
