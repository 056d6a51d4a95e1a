// tests/support/test_seed.h -- the seed of random inputs.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace cordis::test {

/// CORDIS_RANDOM_SEED of the environment, else @p usual, so that a test is the same on every run.
inline std::uint32_t test_seed(std::uint32_t usual = 1) {
  const char* text = std::getenv("CORDIS_RANDOM_SEED");
  return text != nullptr ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : usual;
}

}  // namespace cordis::test
