// tests/cli/control_words_test.cpp
#include "cli/ctl/control_words.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

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
  for (const auto& [word, verb] : {std::pair{"pause", msg::VERB_PAUSE},
                                   {"resume", msg::VERB_RESUME},
                                   {"reset", msg::VERB_RESET},
                                   {"step", msg::VERB_STEP},
                                   {"get", msg::VERB_GET}}) {
    const ControlWords command = read_control_words(word, {});
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
  const std::string too_long(5000, 'x');
  EXPECT_EQ(read_control_words("load", {too_long}).argument, "'" + too_long + "'");
}

TEST(ControlWords, MakeAMappingOfNewValues) {
  EXPECT_EQ(read_control_words("set", {"rosin.hold_m=0.003", "a.b.c=-1"}).argument,
            "{'rosin.hold_m': 0.003, 'a.b.c': -1}");
  EXPECT_EQ(refusal_of("set", {}), "write: set NAME.PARAMETER=VALUE ...");
  for (const char* word : {"hold_m=3", "rosin.hold_m", "rosin.hold_m=", "=3"})
    EXPECT_EQ(refusal_of("set", {word}),
              "'" + std::string(word) + "' is not of the form NAME.PARAMETER=VALUE");
}

TEST(ControlWords, TakeWhatGetPrintsAsNewValues) {
  const std::string wanted = "{'a.b': 1, 'c.d': -2}";
  for (const auto& words :
       std::vector<std::vector<std::string>>{{"a.b = 1", "c.d =-2"},
                                             {"a.b", "=", "1", "c.d", "=", "-2"},
                                             {"a.b=", "1", "c.d", "=-2"}})
    EXPECT_EQ(read_control_words("set", words).argument, wanted) << words.front();
  EXPECT_EQ(refusal_of("set", {"a.b", "=", "1", "2"}),
            "'2' is not of the form NAME.PARAMETER=VALUE");
  EXPECT_EQ(refusal_of("set", {"a.b", "="}), "'a.b=' is not of the form NAME.PARAMETER=VALUE");
  EXPECT_EQ(refusal_of("set", {"a.b = "}), "'a.b = ' is not of the form NAME.PARAMETER=VALUE");
}

TEST(ControlWords, TakeATimeFromTheBeginningOfATakeOn) {
  EXPECT_EQ(read_control_words("seek", {"0s"}).argument, "0");
  EXPECT_EQ(read_control_words("seek", {"0"}).argument, "0");
  EXPECT_EQ(read_control_words("seek", {"1500ms"}).argument, "1.5");
  EXPECT_EQ(refusal_of("seek", {"-1s"}), "'-1s' is not a duration: it must be 0 or longer");
  EXPECT_EQ(refusal_of("seek", {}), "write: seek TIME");
}

TEST(ControlWords, NameLinksAndTheirState) {
  EXPECT_EQ(read_control_words("state", {"rosin[3]", "unhooked"}).argument,
            "['rosin[3]', 'unhooked']");
  EXPECT_EQ(refusal_of("state", {"rosin"}), "write: state LINKS STATE");
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
