// tests/node/command_server_test.cpp
#include "node/command_server.h"

#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "node/background_work.h"
#include "tests/support/eventually.h"

namespace cordis::node {
namespace {

msg::ControlCommand command_for(const std::string& target, std::uint64_t id,
                                const std::string& sender = "me") {
  msg::ControlCommand command;
  command.command_id(id);
  command.sender(sender);
  command.target(target);
  command.verb(msg::VERB_PAUSE);
  return command;
}

struct ServerOfSim {
  std::vector<msg::ControlVerb> executed;
  CommandServer server{"sim", msg::KIND_SIM_NODE, [this](const msg::ControlCommand& command) {
                         executed.push_back(command.verb());
                         return Answer{true, "answer " + std::to_string(executed.size())};
                       }};
};

TEST(CommandServer, ExecutesWhatIsForItByNameByKindOrForAll) {
  ServerOfSim server;
  std::uint64_t id = 0;
  for (const char* target : {"sim", "sim_node", "*"}) {
    const auto reply = server.server.take(command_for(target, ++id));
    ASSERT_TRUE(reply.has_value()) << target;
    EXPECT_EQ(reply->command_id(), id);
    EXPECT_EQ(reply->sender(), "me");
    EXPECT_EQ(reply->node(), "sim");
    EXPECT_TRUE(reply->accepted());
    EXPECT_EQ(reply->text(), "answer " + std::to_string(id));
  }
}

TEST(CommandServer, IsSilentAboutWhatIsForOthers) {
  ServerOfSim server;
  for (const char* target : {"", "simulation", "keyboard", "device_node"})
    EXPECT_FALSE(server.server.take(command_for(target, 1)).has_value()) << target;
  EXPECT_TRUE(server.executed.empty());
}

TEST(CommandServer, ExecutesACommandOnceHoweverOftenItComes) {
  ServerOfSim server;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(server.server.take(command_for("sim", 7))->text(), "answer 1");
  EXPECT_EQ(server.executed.size(), 1u);
}

TEST(CommandServer, DistinguishesSendersThatUseTheSameNumber) {
  ServerOfSim server;
  static_cast<void>(server.server.take(command_for("sim", 7, "one")));
  EXPECT_EQ(server.server.take(command_for("sim", 7, "other"))->text(), "answer 2");
}

TEST(CommandServer, RemembersABoundedNumberOfCommands) {
  ServerOfSim server;
  for (std::uint64_t id = 0; id <= CommandServer::kRemembered; ++id)
    static_cast<void>(server.server.take(command_for("sim", id)));
  const std::size_t before = server.executed.size();

  static_cast<void>(server.server.take(command_for("sim", 1)));
  EXPECT_EQ(server.executed.size(), before) << "still known";
  static_cast<void>(server.server.take(command_for("sim", 0)));
  EXPECT_EQ(server.executed.size(), before + 1) << "forgotten, and executed as a new one";
}

TEST(CommandServer, OfASessionWithAKeyTakesNoNumberFromASenderWithIt) {
  const SessionKey key = SessionKey::random();
  const CommandedNode sim{"sim", 5};
  int executed = 0;
  CommandServer server(
      "sim", msg::KIND_SIM_NODE,
      [&executed](const msg::ControlCommand&) {
        ++executed;
        return Answer{true, "done"};
      },
      {}, CommandGuard(key, "s", sim));
  msg::ControlCommand command = command_for("sim", 1);

  const auto refused = server.take(command);  // of a stranger who has guessed number and sender
  ASSERT_TRUE(refused.has_value());
  EXPECT_FALSE(refused->accepted());
  EXPECT_EQ(executed, 0);

  authenticate(command, key, "s", {sim});
  EXPECT_TRUE(server.take(command)->accepted());
  EXPECT_TRUE(server.take(command)->accepted()) << "it is answered again";
  EXPECT_EQ(executed, 1) << "and not executed again";

  for (std::uint64_t id = 2; id <= 2 + CommandServer::kRemembered; ++id) {
    msg::ControlCommand later = command_for("sim", id);
    authenticate(later, key, "s", {sim});
    EXPECT_TRUE(server.take(later)->accepted());
  }
  const int before = executed;
  EXPECT_FALSE(server.take(command)->accepted()) << "its reply is forgotten, the command is not";
  EXPECT_EQ(executed, before);
}

TEST(CommandServer, ExecutesOthersWhileTheLongPartOfACommandIsUnderWay) {
  std::promise<void> end_of_work;
  int works = 0;
  CommandServer server(
      "sim", msg::KIND_SIM_NODE,
      [](const msg::ControlCommand&) {
        return Answer{true, "at once"};
      },
      [&](const msg::ControlCommand& command) -> Work {
        if (command.verb() != msg::VERB_LOAD) return {};
        return [&]() -> Finish {
          end_of_work.get_future().wait();
          ++works;
          return [] { return Answer{true, "loaded"}; };
        };
      });
  msg::ControlCommand load = command_for("sim", 1);
  load.verb(msg::VERB_LOAD);
  msg::ControlCommand other_load = command_for("sim", 3);
  other_load.verb(msg::VERB_LOAD);

  EXPECT_FALSE(server.take(load).has_value());
  EXPECT_EQ(server.take(command_for("sim", 2))->text(), "at once");
  EXPECT_FALSE(server.take(load).has_value()) << "sent again";
  EXPECT_EQ(server.take(other_load)->text(),
            "a 'load' is still under way; send this one after its reply");
  EXPECT_FALSE(server.take_finished().has_value());
  EXPECT_TRUE(server.is_working());

  end_of_work.set_value();
  std::optional<msg::ControlReply> reply;
  ASSERT_TRUE(test::eventually([&] {
    reply = server.take_finished();
    return reply.has_value();
  }));
  EXPECT_EQ(reply->command_id(), 1U);
  EXPECT_EQ(reply->text(), "loaded");
  EXPECT_FALSE(server.is_working());
  EXPECT_EQ(server.take(load)->text(), "loaded") << "and answered again";
  EXPECT_EQ(works, 1);
}

TEST(CommandServer, EndsBesideALongPart) {
  std::promise<void> end_of_work;
  {
    CommandServer server(
        "sim", msg::KIND_SIM_NODE, [](const msg::ControlCommand&) { return Answer{}; },
        [work_may_end = end_of_work.get_future().share()](const msg::ControlCommand&) -> Work {
          return [work_may_end]() -> Finish {
            work_may_end.wait();
            return [] { return Answer{true, "loaded"}; };
          };
        });
    EXPECT_FALSE(server.take(command_for("sim", 1)).has_value());
    EXPECT_TRUE(server.is_working());
  }
  EXPECT_TRUE(background_work_is_under_way());
  end_of_work.set_value();
  EXPECT_TRUE(test::eventually([] { return !background_work_is_under_way(); }));
}

TEST(CommandServer, AnswersAFailureOfALongPartWithItsReason) {
  CommandServer server(
      "sim", msg::KIND_SIM_NODE, [](const msg::ControlCommand&) { return Answer{}; },
      [](const msg::ControlCommand&) -> Work {
        return []() -> Finish { throw std::runtime_error("no memory for it"); };
      });
  EXPECT_FALSE(server.take(command_for("sim", 1)).has_value());
  std::optional<msg::ControlReply> reply;
  ASSERT_TRUE(test::eventually([&] {
    reply = server.take_finished();
    return reply.has_value();
  }));
  EXPECT_FALSE(reply->accepted());
  EXPECT_EQ(reply->text(), "no memory for it");
}

TEST(CommandServer, AnswersAFailureWithItsReason) {
  CommandServer server("sim", msg::KIND_SIM_NODE, [](const msg::ControlCommand&) -> Answer {
    throw std::runtime_error("no memory for it");
  });
  const auto reply = server.take(command_for("sim", 1));
  ASSERT_TRUE(reply.has_value());
  EXPECT_FALSE(reply->accepted());
  EXPECT_EQ(reply->text(), "no memory for it");
}

}  // namespace
}  // namespace cordis::node
