// tests/node/command_guard_test.cpp
#include "node/command_guard.h"

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

using Verdict = CommandGuard::Verdict;

const SessionKey kKey("000102030405060708090a0b0c0d0e0f");
const CommandedNode kSim{"sim", 5};

msg::ControlCommand command_of(std::uint64_t id, msg::ControlVerb verb = msg::VERB_SET,
                               const std::string& sender = "me") {
  msg::ControlCommand command;
  command.command_id(id);
  command.sender(sender);
  command.target("sim_node");
  command.verb(verb);
  command.argument("{finger.mass_kg: 2}");
  return command;
}

msg::ControlCommand with_key(msg::ControlCommand command, const SessionKey& key = kKey,
                             const std::vector<CommandedNode>& nodes = {kSim}) {
  authenticate(command, key, "s", nodes);
  return command;
}

CommandGuard guard_of_sim() {
  return {kKey, "s", kSim};
}

constexpr msg::ControlVerb kVerbs[] = {msg::VERB_PAUSE, msg::VERB_RESUME, msg::VERB_STEP,
                                       msg::VERB_RESET, msg::VERB_LOAD,   msg::VERB_SET,
                                       msg::VERB_STATE, msg::VERB_SEEK,   msg::VERB_RATE};

TEST(CommandGuard, LetsACommandWithTheKeyPassOnce) {
  CommandGuard guard = guard_of_sim();
  std::uint64_t id = 0;
  for (const msg::ControlVerb verb : kVerbs) {
    const msg::ControlCommand command = with_key(command_of(++id, verb));
    EXPECT_EQ(guard.evaluate(command), Verdict::kPasses) << verb;
    EXPECT_EQ(guard.evaluate(command), Verdict::kRefused) << verb;
    EXPECT_NE(guard.reason().find("was executed before"), std::string::npos) << guard.reason();
  }
}

TEST(CommandGuard, RefusesWhatHasNoKey) {
  CommandGuard guard = guard_of_sim();
  for (const msg::ControlVerb verb : kVerbs) {
    EXPECT_EQ(guard.evaluate(command_of(1, verb)), Verdict::kRefused) << verb;
    EXPECT_NE(guard.reason().find("commands of its own user alone"), std::string::npos)
        << guard.reason();
  }
  EXPECT_EQ(guard.evaluate(command_of(1, msg::VERB_GET)), Verdict::kPasses) << "it changes nothing";
}

TEST(CommandGuard, RefusesAnotherKeyAndAnotherSession) {
  CommandGuard guard = guard_of_sim();
  EXPECT_EQ(guard.evaluate(with_key(command_of(1), SessionKey::random())), Verdict::kRefused);
  EXPECT_NE(guard.reason().find("another key"), std::string::npos) << guard.reason();
  msg::ControlCommand command = command_of(1);
  authenticate(command, kKey, "another", {kSim});
  EXPECT_EQ(guard.evaluate(command), Verdict::kRefused);
  EXPECT_EQ(guard.evaluate(with_key(command_of(1))), Verdict::kPasses);
}

TEST(CommandGuard, RefusesEveryChangeOfACommandWithTheKey) {
  std::mt19937_64 random(20261125);
  for (int round = 0; round < 300; ++round) {
    CommandGuard guard = guard_of_sim();
    msg::ControlCommand command = with_key(command_of(10));
    switch (random() % 6) {
      case 0:
        command.command_id(11 + random() % 1000);
        break;
      case 1:
        command.sender("you");
        break;
      case 2:
        command.target("*");
        break;
      case 3:
        command.verb(kVerbs[random() % 5]);
        break;
      case 4:
        command.argument(command.argument() + static_cast<char>(random() % 256));
        break;
      default:
        command.authenticators()[0].code()[random() % 32] ^=
            static_cast<std::uint8_t>(1 + random() % 255);
    }
    EXPECT_EQ(guard.evaluate(command), Verdict::kRefused) << round;
  }
}

TEST(CommandGuard, RefusesAReplayHoweverManyCommandsLater) {
  CommandGuard guard = guard_of_sim();
  std::vector<msg::ControlCommand> seen;
  for (std::uint64_t id = 1; id <= 500; ++id) {
    seen.push_back(with_key(command_of(id, msg::VERB_SET, id % 2 == 0 ? "me" : "you")));
    ASSERT_EQ(guard.evaluate(seen.back()), Verdict::kPasses);
  }
  for (const msg::ControlCommand& command : seen)
    EXPECT_EQ(guard.evaluate(command), Verdict::kRefused) << command.command_id();
}

TEST(CommandGuard, DoesNotExecuteWhatWasSentToAnEarlierLifeOfItsNode) {
  const msg::ControlCommand command = with_key(command_of(1));
  CommandGuard next(kKey, "s", {"sim", 6});
  EXPECT_EQ(next.evaluate(command), Verdict::kIsForOthers);
  msg::ControlCommand forged = command;
  forged.authenticators()[0].epoch(6);
  EXPECT_EQ(next.evaluate(forged), Verdict::kRefused);
}

TEST(CommandGuard, IsSilentAboutWhatWasMeantForOthers) {
  CommandGuard guard = guard_of_sim();
  EXPECT_EQ(guard.evaluate(with_key(command_of(1), kKey, {{"keyboard", 5}})),
            Verdict::kIsForOthers);
  EXPECT_EQ(guard.evaluate(with_key(command_of(1), kKey, {{"keyboard", 5}, kSim})),
            Verdict::kPasses);
}

TEST(CommandGuard, RefusesAFloodOfAuthenticators) {
  CommandGuard guard = guard_of_sim();
  msg::ControlCommand command = with_key(command_of(1));
  command.authenticators().resize(100'000, command.authenticators()[0]);
  EXPECT_EQ(guard.evaluate(command), Verdict::kRefused);
  const std::vector<CommandedNode> many(1000, kSim);
  EXPECT_LE(with_key(command_of(1), kKey, many).authenticators().size(), 64u);
}

TEST(CommandGuard, WithoutAKeyLetsAllPass) {
  CommandGuard guard;
  EXPECT_EQ(guard.evaluate(command_of(1)), Verdict::kPasses);
  EXPECT_EQ(guard.evaluate(command_of(1)), Verdict::kPasses);
  EXPECT_EQ(guard.evaluate(with_key(command_of(1), SessionKey::random())), Verdict::kPasses);
}

}  // namespace
}  // namespace cordis::node
