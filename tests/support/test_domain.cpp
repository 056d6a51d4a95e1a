// tests/support/test_domain.cpp
#include "tests/support/test_domain.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <unistd.h>

#include "node/domain_lock.h"

namespace cordis::test {
namespace {

constexpr int kFirstDomain = 10;
constexpr int kDomainCount = 92;

int find_free_domain() {
  const int start = static_cast<int>(getpid()) % kDomainCount;
  for (int i = 0; i < kDomainCount; ++i) {
    const int domain = kFirstDomain + (start + i) % kDomainCount;
    if (node::lock_domain(domain) >= 0) return domain;  // closed by the end of the process
  }
  std::fputs("no DDS domain is free for this test\n", stderr);
  std::abort();
}

}  // namespace

int own_domain() {
  static const int kDomain = [] {
    const std::string folder = "/tmp/cordis-tests-" + std::to_string(geteuid());
    setenv("CORDIS_RUNTIME_DIR", folder.c_str(), /*overwrite=*/0);
    return find_free_domain();
  }();
  return kDomain;
}

}  // namespace cordis::test
