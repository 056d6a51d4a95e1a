// sim_node/engine/core/assert.h -- checks of preconditions.
#pragma once

namespace cordis::engine {

/// Prints the condition and its place on stderr, and aborts.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line) noexcept;

}  // namespace cordis::engine

/// Aborts when a precondition does not hold. Active where CORDIS_ASSERTIONS is defined: in debug and
/// sanitizer builds, and in the engine of the golden tests. Elsewhere it is compiled, never evaluated.
#ifdef CORDIS_ASSERTIONS
#define CORDIS_ASSERT(condition)      \
  ((condition) ? static_cast<void>(0) \
               : ::cordis::engine::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define CORDIS_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif
