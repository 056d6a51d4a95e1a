// sim_node/engine/core/assert.cpp
#include "sim_node/engine/core/assert.h"

#include <cstdio>
#include <cstdlib>

namespace cordis::engine {

void assertion_failed(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "%s:%d: this does not hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace cordis::engine
