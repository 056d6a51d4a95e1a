// node/random_token.cpp
#include "node/random_token.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include <sys/random.h>

namespace cordis::node {

std::string random_token() {
  std::array<std::uint8_t, 16> bytes{};
  ssize_t filled = -1;
  do {
    filled = getrandom(bytes.data(), bytes.size(), 0);  // up to 256 bytes come at once
  } while (filled < 0 && errno == EINTR);
  if (filled != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error(std::string("no random numbers from the kernel: ") +
                             std::strerror(errno));
  constexpr const char* kDigits = "0123456789abcdef";
  std::string token;
  for (const std::uint8_t byte : bytes) {
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

}  // namespace cordis::node
