// node/assert.h -- checks of preconditions, for every folder: it includes nothing of Cordis.
#pragma once

/// Aborts when a precondition does not hold. Active where CORDIS_ASSERTIONS is defined: in debug and
/// sanitizer builds, and in the engine of the golden tests. Elsewhere it is compiled, never evaluated.
#ifdef CORDIS_ASSERTIONS

#include <cstdio>
#include <cstdlib>

namespace cordis {

/// Prints the condition and its place on stderr, and aborts.
[[noreturn, gnu::cold, gnu::noinline]] inline void assertion_failed(const char* condition,
                                                                    const char* file,
                                                                    int line) noexcept {
  std::fprintf(stderr, "%s:%d: this does not hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace cordis

#define CORDIS_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::cordis::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define CORDIS_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif
