// tests/cli/command_line_test.cpp
#include "cli/command_line.h"

#include <gtest/gtest.h>

#include "cli/exit_code.h"
#include "node/config/problem.h"
#include "tests/cli/captured_run.h"

namespace cordis::cli {
namespace {

using Words = std::vector<std::string>;

/// A program with the verbs `run` and `test`, whose output is kept.
struct Program {
  CommandLine line{"cordis", "Summary of the program.", "1.2.3"};
  std::string file;
  std::string duration;
  Words more;
  Words only;
  Words handed_on;
  bool dry = false;
  std::function<int()> act = [] { return 0; };
  std::string out;
  std::string error;

  Program() {
    Verb& run = line.verb("run", "FILE [options]", "Summary of run");
    run.required_word("FILE", file, "The file");
    run.more_words("NAME.key=value", more, "Replace");
    run.option("--duration", "TIME", duration, "How long");
    run.list("--only", "NAME,...", only, "Some");
    run.flag("--dry-run", dry, "Nothing");
    run.examples("Examples of run");
    run.action([this] { return act(); });
    Verb& test = line.verb("test", "[options of ctest]", "Summary of test");
    test.hand_on_words(handed_on);
    test.action([] { return 7; });
  }

  int operator()(const Words& words) { return run_captured(line, words, out, error); }
};

TEST(CommandLine, TakesAWordThatIsAlsoAVerb) {
  Program program;
  ASSERT_EQ(program({"run", "test", "run"}), 0);
  EXPECT_EQ(program.file, "test");
  EXPECT_EQ(program.more, Words{"run"});
}

TEST(CommandLine, FillsInWhatWasTyped) {
  Program program;
  ASSERT_EQ(program({"run", "a.yaml", "sim.x=-1", "--duration", "3s", "key.y=a b", "--only",
                     "sim,key", "--dry-run"}),
            0);
  EXPECT_EQ(program.file, "a.yaml");
  EXPECT_EQ(program.more, (Words{"sim.x=-1", "key.y=a b"}));
  EXPECT_EQ(program.duration, "3s");
  EXPECT_EQ(program.only, (Words{"sim", "key"}));
  EXPECT_TRUE(program.dry);
}

TEST(CommandLine, ReturnsWhatTheVerbReturns) {
  Program program;
  program.act = [] { return 137; };
  EXPECT_EQ(program({"run", "a.yaml"}), 137);
}

TEST(CommandLine, HandsOnEveryWordOfAnotherProgram) {
  Program program;
  EXPECT_EQ(program({"test", "-R", "a b", "--verbose", "-j4"}), 7);
  EXPECT_EQ(program.handed_on, (Words{"-R", "a b", "--verbose", "-j4"}));
}

TEST(CommandLine, ExplainsItselfOnStdout) {
  Program program;
  EXPECT_EQ(program({"--help"}), kSuccess);
  for (const char* text :
       {"Summary of the program.", "run", "Summary of run", "test", "--version"}) {
    EXPECT_NE(program.out.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(program({"--version"}), kSuccess);
  EXPECT_EQ(program.out, "cordis 1.2.3\n");
}

TEST(CommandLine, ExplainsAVerbOnStdout) {
  Program program;
  EXPECT_EQ(program({"run", "a.yaml", "--help"}), kSuccess);
  for (const char* text :
       {"Usage: cordis run FILE [options]", "--duration TIME", "Examples of run"}) {
    EXPECT_NE(program.out.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(program({"test", "-h"}), kSuccess);
  EXPECT_NE(program.out.find("Usage: cordis test [options of ctest]"), std::string::npos);
}

TEST(CommandLine, NamesTheOptionThatHasTheWordsOfAnUnknownOne) {
  Program program;
  Verb& play = program.line.verb("play", "TAKE", "Summary of play");
  std::string ignored;
  for (const char* option : {"--playback-duration", "--domain", "--start-offset", "--start-rate"})
    play.option(option, "X", ignored, "Help");
  const auto hint = [&](const std::string& option) {
    EXPECT_EQ(program({"play", option, "1s"}), kBadInput);
    const std::string before = "cordis play: unknown option '" + option + "'";
    EXPECT_TRUE(program.error.starts_with(before)) << program.error;
    const std::string rest = program.error.substr(before.size());
    return rest.substr(0, rest.find(" (see"));
  };
  EXPECT_EQ(hint("--duration"), ", did you mean '--playback-duration'?");
  EXPECT_EQ(hint("--offset"), ", did you mean '--start-offset'?");
  EXPECT_EQ(hint("--start"), "") << "two options have that word";
  EXPECT_EQ(hint("--domian"), ", did you mean '--domain'?");
  EXPECT_EQ(hint("--durably"), "") << "dashes make no two options alike";
}

TEST(CommandLine, RefusesInOneLineWithTheNearestWord) {
  const std::vector<std::pair<Words, std::string>> cases{
      {{"rnu", "a.yaml"}, "cordis: unknown verb 'rnu', did you mean 'run'? (see cordis --help)\n"},
      {{""}, "cordis: unknown verb '' (see cordis --help)\n"},
      {{"--hlep"}, "cordis: unknown option '--hlep', did you mean '--help'? (see cordis --help)\n"},
      {{"run"}, "cordis run: FILE is missing (see cordis run --help)\n"},
      {{"run", "--dry-rum"},
       "cordis run: unknown option '--dry-rum', did you mean '--dry-run'? (see cordis run "
       "--help)\n"},
      {{"run", "a.yaml", "--duratoin=3s"},
       "cordis run: unknown option '--duratoin', did you mean '--duration'? (see cordis run "
       "--help)\n"},
      {{"run", "a.yaml", "-x"}, "cordis run: unknown option '-x' (see cordis run --help)\n"},
      {{"run", "a.yaml", "--duration"},
       "cordis run: --duration: 1 required TIME missing (see cordis run --help)\n"},
  };
  for (const auto& [words, refusal] : cases) {
    Program program;
    EXPECT_EQ(program(words), kBadInput) << refusal;
    EXPECT_EQ(program.error, refusal);
    EXPECT_EQ(program.out, "");
  }
}

TEST(CommandLine, ExplainsItselfOnStderrWhenNothingWasTyped) {
  Program program;
  EXPECT_EQ(program({}), kBadInput);
  EXPECT_NE(program.error.find("Usage: cordis VERB"), std::string::npos);
  EXPECT_EQ(program.out, "");
}

TEST(CommandLine, TurnsWhatAVerbThrowsIntoALineAndAnExitCode) {
  Program program;
  program.act = []() -> int { throw UsageError("'3' is no duration"); };
  EXPECT_EQ(program({"run", "a.yaml"}), kBadInput);
  EXPECT_EQ(program.error, "cordis run: '3' is no duration (see cordis run --help)\n");

  program.act = []() -> int { throw std::runtime_error("no DDS here"); };
  EXPECT_EQ(program({"run", "a.yaml"}), kFailure);
  EXPECT_EQ(program.error, "cordis run: no DDS here\n");

  program.act = []() -> int {
    config::Problems problems;
    problems.error({"a.yaml", 3, 1}, "first");
    problems.error({"a.yaml", 4, 1}, "second");
    problems.throw_if_any();
    return 0;
  };
  EXPECT_EQ(program({"run", "a.yaml"}), kBadInput);
  EXPECT_EQ(program.error, "a.yaml:3:1: error: first\na.yaml:4:1: error: second\n");
}

}  // namespace
}  // namespace cordis::cli
