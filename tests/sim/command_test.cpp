// tests/sim/command_test.cpp
#include "sim_node/run/command.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "node/control_verbs.h"

namespace cordis::sim {
namespace {

std::string refusal_of(msg::ControlVerb verb, const std::string& argument) {
  try {
    static_cast<void>(read_command(verb, argument));
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(Command, IsReadFromItsVerbAndArgument) {
  EXPECT_EQ(read_command(msg::VERB_PAUSE, "").verb, msg::VERB_PAUSE);
  EXPECT_EQ(read_command(msg::VERB_RESUME, "").verb, msg::VERB_RESUME);
  EXPECT_EQ(read_command(msg::VERB_RESET, "").verb, msg::VERB_RESET);
  EXPECT_EQ(read_command(msg::VERB_STEP, "").steps, 1u);
  EXPECT_EQ(read_command(msg::VERB_STEP, "250").steps, 250u);
  const Command load = read_command(msg::VERB_LOAD, "'scenes/it''s.yaml'");
  EXPECT_EQ(load.verb, msg::VERB_LOAD);
  EXPECT_EQ(load.scene_file, "scenes/it's.yaml");
}

TEST(Command, SetNamesParametersAndValues) {
  const Command set =
      read_command(msg::VERB_SET, "{'rosin.hold_m': 3e-3, 'a.links.stiffness_n_per_m': 5}");
  EXPECT_EQ(set.verb, msg::VERB_SET);
  ASSERT_EQ(set.values.size(), 2u);
  EXPECT_EQ(set.values[0].name, "rosin");
  EXPECT_EQ(set.values[0].parameter, "hold_m");
  EXPECT_EQ(set.values[0].value, 3e-3);
  EXPECT_EQ(set.values[1].name, "a.links");
  EXPECT_EQ(set.values[1].parameter, "stiffness_n_per_m");
  EXPECT_EQ(refusal_of(msg::VERB_SET, ""), "'set' needs NAME.PARAMETER and a value");
  EXPECT_EQ(refusal_of(msg::VERB_SET, "{hold_m: 3}"), "'hold_m' is not of the form NAME.PARAMETER");
  EXPECT_EQ(refusal_of(msg::VERB_SET, "{a.hold_m: much}"),
            "'a.hold_m' must be a number, got 'much'");
  EXPECT_NE(refusal_of(msg::VERB_SET, "{a.hold_m: .nan}"), "");
}

TEST(Command, StateNamesLinksAndTheirState) {
  const Command state = read_command(msg::VERB_STATE, "['rosin[3]', unhooked]");
  EXPECT_EQ(state.links, "rosin[3]");
  EXPECT_EQ(state.state, "unhooked");
  for (const char* argument : {"", "rosin", "[rosin]", "[a, b, c]", "[[a], b]"})
    EXPECT_EQ(refusal_of(msg::VERB_STATE, argument),
              "'state' needs links and the state they are put into");
}

TEST(Command, OfAnUnknownVerbIsRefused) {
  EXPECT_EQ(refusal_of(static_cast<msg::ControlVerb>(99), ""),
            "a sim_node knows no command 'verb 99'");
}

TEST(Command, WithAWrongArgumentIsRefusedInOneSentence) {
  EXPECT_EQ(refusal_of(msg::VERB_STEP, "0"),
            "the number of steps must be between 1 and 1000000000, got 0");
  EXPECT_EQ(refusal_of(msg::VERB_STEP, "many"),
            "the number of steps must be a whole number, got 'many'");
  EXPECT_EQ(refusal_of(msg::VERB_STEP, "[1]"),
            "the number of steps must be a whole number, got a sequence");
  EXPECT_EQ(refusal_of(msg::VERB_PAUSE, "now"), "'pause' stands alone, got 'now' behind it");
  EXPECT_EQ(refusal_of(msg::VERB_LOAD, ""), "'load' needs the path of a scene");
  EXPECT_EQ(refusal_of(msg::VERB_LOAD, "{a: b}"), "'load' needs the path of a scene");
}

TEST(Command, RateIsThatOfSimulatedTime) {
  EXPECT_EQ(read_command(msg::VERB_RATE, "0.1").time_scale, 0.1);
  EXPECT_EQ(read_command(msg::VERB_RATE, "1").time_scale, 1.0);
  for (const char* argument : {"0.009", "1.001", "-1", "fast", ""})
    EXPECT_NE(refusal_of(msg::VERB_RATE, argument), "") << argument;
  EXPECT_EQ(refusal_of(msg::VERB_RATE, "2"),
            "the rate of a simulation must be between 0.01 and 1, got 2");
}

TEST(Command, WithDamagedYamlIsRefused) {
  for (const char* argument : {"[", "{a", "'", "\x01", "a: b: c", "!tag x", "\xff"})
    EXPECT_NE(refusal_of(msg::VERB_LOAD, argument), "") << argument;
}

TEST(Command, IsKnownForEveryVerbOfTheList) {
  for (const node::ControlVerb& verb : node::control_verbs()) {
    const bool is_of_a_player = verb.verb == msg::VERB_SEEK;
    const std::size_t found = refusal_of(verb.verb, "").find("knows no command");
    EXPECT_EQ(found != std::string::npos, is_of_a_player) << verb.name;
  }
}

}  // namespace
}  // namespace cordis::sim
