// cli/test/test_verb.cpp
#include "cli/test/test_verb.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <unistd.h>

#include "cli/programs.h"
#include "cli/test/test_words.h"

namespace cordis::cli {
namespace {

/// The folder whose tests are meant: all build trees side by side when ./cordis has gathered them,
/// else that of this program alone.
std::filesystem::path test_directory() {
  const std::filesystem::path tree = program_directory().parent_path();
  const std::filesystem::path all = tree.parent_path();
  return std::filesystem::exists(all / "CTestTestfile.cmake") ? all : tree;
}

int hand_over_to_ctest(const TestWords& asked) {
  const std::string directory = test_directory();
  std::vector<std::string> words{
      "ctest",
      "--test-dir",
      directory,
      "--output-on-failure",
      "--no-tests=error",
      "-j" + std::to_string(std::thread::hardware_concurrency() +
                            1)};  // tests of processes wait more than they compute
  words.insert(words.end(), asked.ctest.begin(), asked.ctest.end());
  if (asked.soak_s > 0.0) setenv("CORDIS_SOAK_S", std::to_string(asked.soak_s).c_str(), 1);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  throw std::runtime_error(std::string("cannot start ctest: ") + std::strerror(errno));
}

}  // namespace

void add_test_verb(CommandLine& line) {
  auto ctest_options = std::make_shared<std::vector<std::string>>();
  Verb& verb = line.verb("test", "[--long [--hours N]] [options of ctest]",
                         "Run the tests; ./cordis builds them first");
  verb.hand_on_words(*ctest_options);
  verb.examples(
      "Examples:\n"
      "  cordis test                    # all tests, also under the sanitizers\n"
      "  cordis test -L unit            # those with a label: unit, golden, integration\n"
      "  cordis test -R World -V        # those whose name matches, with all they print\n"
      "  cordis test --long -N          # names of the campaigns, which --long runs for many "
      "hours\n"
      "  cordis test --long --hours 8 -R Soak -N  # those whose sessions last 8 hours\n");
  verb.action([ctest_options] { return hand_over_to_ctest(test_words(*ctest_options)); });
}

}  // namespace cordis::cli
