// tests/sim/command_test.cpp
#include "sim_node/run/command.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "node/control_verbs.h"

namespace cordis::sim {
namespace {

std::string refusal_of(const std::string& verb, const std::string& argument) {
  try {
    read_command(verb, argument);
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(Command, IsReadFromItsVerbAndArgument) {
  EXPECT_EQ(read_command("pause", "").verb, Verb::kPause);
  EXPECT_EQ(read_command("resume", "").verb, Verb::kResume);
  EXPECT_EQ(read_command("reset", "").verb, Verb::kReset);
  EXPECT_EQ(read_command("step", "").steps, 1u);
  EXPECT_EQ(read_command("step", "250").steps, 250u);
  const Command load = read_command("load", "'scenes/it''s.yaml'");
  EXPECT_EQ(load.verb, Verb::kLoad);
  EXPECT_EQ(load.scene_file, "scenes/it's.yaml");
}

TEST(Command, SetNamesParametersAndValues) {
  const Command set = read_command("set", "{'rosin.hold_m': 3e-3, 'a.links.stiffness_n_per_m': 5}");
  EXPECT_EQ(set.verb, Verb::kSet);
  ASSERT_EQ(set.values.size(), 2u);
  EXPECT_EQ(set.values[0].name, "rosin");
  EXPECT_EQ(set.values[0].parameter, "hold_m");
  EXPECT_EQ(set.values[0].value, 3e-3);
  EXPECT_EQ(set.values[1].name, "a.links");
  EXPECT_EQ(set.values[1].parameter, "stiffness_n_per_m");
  EXPECT_EQ(refusal_of("set", ""), "'set' needs NAME.PARAMETER and a value");
  EXPECT_EQ(refusal_of("set", "{hold_m: 3}"), "'hold_m' is not of the form NAME.PARAMETER");
  EXPECT_EQ(refusal_of("set", "{a.hold_m: much}"), "'a.hold_m' must be a number, got 'much'");
  EXPECT_NE(refusal_of("set", "{a.hold_m: .nan}"), "");
}

TEST(Command, StateNamesLinksAndTheirState) {
  const Command state = read_command("state", "['rosin[3]', unhooked]");
  EXPECT_EQ(state.links, "rosin[3]");
  EXPECT_EQ(state.state, "unhooked");
  for (const char* argument : {"", "rosin", "[rosin]", "[a, b, c]", "[[a], b]"})
    EXPECT_EQ(refusal_of("state", argument), "'state' needs links and the state they are put into");
}

TEST(Command, OfAnUnknownVerbIsRefusedWithTheNearest) {
  EXPECT_EQ(refusal_of("pauze", ""), "a sim_node knows no command 'pauze', did you mean 'pause'?");
  EXPECT_EQ(refusal_of("", ""), "a sim_node knows no command ''");
}

TEST(Command, WithAWrongArgumentIsRefusedInOneSentence) {
  EXPECT_EQ(refusal_of("step", "0"), "the number of steps must be between 1 and 1000000000, got 0");
  EXPECT_EQ(refusal_of("step", "many"), "the number of steps must be a whole number, got 'many'");
  EXPECT_EQ(refusal_of("step", "[1]"),
            "the number of steps must be a whole number, got a sequence");
  EXPECT_EQ(refusal_of("pause", "now"), "'pause' stands alone, got 'now' behind it");
  EXPECT_EQ(refusal_of("load", ""), "'load' needs the path of a scene");
  EXPECT_EQ(refusal_of("load", "{a: b}"), "'load' needs the path of a scene");
}

TEST(Command, WithDamagedYamlIsRefused) {
  for (const char* argument : {"[", "{a", "'", "\x01", "a: b: c", "!tag x", "\xff"})
    EXPECT_NE(refusal_of("load", argument), "") << argument;
}

TEST(Command, IsKnownForEveryVerbOfTheList) {
  for (const node::ControlVerb& verb : node::control_verbs())
    EXPECT_EQ(refusal_of(verb.name, "").find("knows no command"), std::string::npos) << verb.name;
}

}  // namespace
}  // namespace cordis::sim
