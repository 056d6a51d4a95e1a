// tests/support/test_domain.cpp
#include "tests/support/test_domain.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

#include "node/domain_lock.h"

namespace cordis::test {
namespace {

constexpr int kFirstDomain = 10;
constexpr int kDomainCount = 92;

/// Removed at the end of the process, unless there was one already.
class RuntimeFolder {
 public:
  RuntimeFolder() {
    if (std::getenv(kVariable) != nullptr) return;
    std::string pattern = "/tmp/cordis-tests-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) {
      std::perror("no folder for the sessions of this test");
      std::abort();
    }
    path_ = pattern;
    setenv(kVariable, path_.c_str(), /*overwrite=*/0);
  }
  ~RuntimeFolder() {
    std::error_code ignored;
    if (!path_.empty() && getpid() == owner_) std::filesystem::remove_all(path_, ignored);
  }
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;

 private:
  static constexpr const char* kVariable = "CORDIS_RUNTIME_DIR";
  std::string path_;
  pid_t owner_ = getpid();  // a fork of it leaves the folder
};

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
    static const RuntimeFolder kFolder;
    return find_free_domain();
  }();
  return kDomain;
}

}  // namespace cordis::test
