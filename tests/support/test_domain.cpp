// tests/support/test_domain.cpp
#include "tests/support/test_domain.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace cordis::test {
namespace {

constexpr int kFirstDomain = 10;
constexpr int kDomainCount = 92;

bool hold(int domain) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // An abstract name: it is free again when the process ends, whichever way.
  const int length = std::snprintf(address.sun_path + 1, sizeof address.sun_path - 1,
                                   "cordis/test/domain/%d", domain);
  const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1) + static_cast<socklen_t>(length);
  if (bind(file, reinterpret_cast<const sockaddr*>(&address), size) == 0) return true;
  close(file);
  return false;
}

int find_free_domain() {
  const int start = static_cast<int>(getpid()) % kDomainCount;
  for (int i = 0; i < kDomainCount; ++i) {
    const int domain = kFirstDomain + (start + i) % kDomainCount;
    if (hold(domain)) return domain;
  }
  std::fputs("no DDS domain is free for this test\n", stderr);
  std::abort();
}

}  // namespace

int own_domain() {
  static const int kDomain = find_free_domain();
  return kDomain;
}

}  // namespace cordis::test
