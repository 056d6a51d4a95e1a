// tests/cli/reference_test.cpp -- docs/cli.md is the help of the program.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "cli/verbs.h"

namespace cordis::cli {
namespace {

constexpr const char* kFile = CORDIS_SOURCE_DIR "/docs/cli.md";
constexpr const char* kBeginning =
    R"(# The command line

This file is made from the help texts of the program; `cordis VERB --help` prints the same. A
test keeps both equal. To write it again, run
`CORDIS_WRITE_DOCS=1 build/release/bin/cli_test --gtest_filter=Reference.*`.

)";

std::string document() {
  CommandLine line("cordis", "Physical objects that you can build from parts, touch and see.",
                   "1.2.3");
  add_verbs(line);
  return kBeginning + line.reference();
}

TEST(Reference, IsTheDocument) {
  const std::string expected = document();
  if (std::getenv("CORDIS_WRITE_DOCS") != nullptr) std::ofstream(kFile) << expected;

  std::ifstream file(kFile);
  const std::string written(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(written, expected)
      << "docs/cli.md is not the help of the program: write it again with\n"
      << "  CORDIS_WRITE_DOCS=1 build/release/bin/cli_test --gtest_filter=Reference.*";
}

TEST(Reference, HasEveryVerbAndItsOptions) {
  const std::string text = document();
  for (const char* part : {"## cordis run", "## cordis test", "| `--dry-run` |", "| `--domain N` |",
                           "| `FILE\\|SESSION` |", "```sh\ncordis doctor\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace cordis::cli
