// node/random_token.h -- secrets that cannot be guessed.
#pragma once

#include <string>

namespace cordis::node {

/// 128 bits of the kernel's random numbers, as 32 hexadecimal digits.
/// @throws std::runtime_error when the kernel gives none.
std::string random_token();

}  // namespace cordis::node
