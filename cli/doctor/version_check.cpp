// cli/doctor/version_check.cpp
#include "cli/doctor/version_check.h"

#include "node/dds/library_version.h"

namespace cordis::cli {
namespace {

#ifdef __clang__
constexpr const char* kCompiler = __VERSION__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

Finding check_versions(const std::string& release) {
  const std::string dds = dds::library_version();
  Finding finding{.key = "versions", .title = "versions"};
  finding.text = "Cordis " CORDIS_VERSION ", " + dds + ", Linux " + release + ", " + kCompiler;
  finding.values = {
      {"cordis", CORDIS_VERSION}, {"dds", dds}, {"kernel", release}, {"compiler", kCompiler}};
  return finding;
}

}  // namespace cordis::cli
