// tests/cli/control_words_test.cpp
#include "cli/control_words.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

std::string refusal_of(const std::string& verb, const std::vector<std::string>& words) {
  try {
    read_control_words(verb, words);
  } catch (const UsageError& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(ControlWords, LeaveACommandWithoutWordsAlone) {
  for (const char* verb : {"pause", "resume", "reset", "step"}) {
    const ControlWords command = read_control_words(verb, {});
    EXPECT_EQ(command.verb, verb);
    EXPECT_EQ(command.argument, "");
  }
}

TEST(ControlWords, HandOnTheNumberOfSteps) {
  EXPECT_EQ(read_control_words("step", {"12"}).argument, "12");
}

TEST(ControlWords, MakeAPathThatExistsHereAbsoluteAndQuoteIt) {
  const std::string here = std::filesystem::current_path().string();
  EXPECT_EQ(read_control_words("load", {"."}).argument, "'" + here + "/.'");
  EXPECT_EQ(read_control_words("load", {"no such: 'file'"}).argument, "'no such: ''file'''");
}

TEST(ControlWords, RefuseAnUnknownCommandWithTheNearest) {
  EXPECT_EQ(refusal_of("paus", {}), "there is no command 'paus', did you mean 'pause'?");
  EXPECT_EQ(refusal_of("xyzzy", {}), "there is no command 'xyzzy'");
}

TEST(ControlWords, RefuseTooFewAndTooManyWords) {
  EXPECT_EQ(refusal_of("load", {}), "write: load SCENE");
  EXPECT_EQ(refusal_of("load", {"a", "b"}), "write: load SCENE");
  EXPECT_EQ(refusal_of("step", {"1", "2"}), "write: step [N]");
  EXPECT_EQ(refusal_of("pause", {"now"}), "write: pause");
}

TEST(ControlWords, AreAllInTheHelp) {
  const std::string help = control_verb_list();
  for (const char* verb : {"pause", "resume", "step [N]", "reset", "load SCENE"})
    EXPECT_NE(help.find(verb), std::string::npos) << verb;
}

}  // namespace
}  // namespace cordis::cli
