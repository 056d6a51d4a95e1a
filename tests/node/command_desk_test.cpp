// tests/node/command_desk_test.cpp
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "node/command_server.h"

namespace cordis::node {
namespace {

msg::ControlCommand command_for(const std::string& target, std::uint64_t id,
                                const std::string& sender = "me") {
  msg::ControlCommand command;
  command.command_id(id);
  command.sender(sender);
  command.target(target);
  command.verb("pause");
  return command;
}

struct Desk {
  std::vector<std::string> obeyed;
  CommandServer desk{"sim", "sim_node", [this](const msg::ControlCommand& command) {
                       obeyed.push_back(command.verb());
                       return Answer{true, "answer " + std::to_string(obeyed.size())};
                     }};
};

TEST(CommandServer, ObeysWhatIsForItByNameByKindOrForAll) {
  Desk desk;
  std::uint64_t id = 0;
  for (const char* target : {"sim", "sim_node", "*"}) {
    const auto reply = desk.desk.take(command_for(target, ++id));
    ASSERT_TRUE(reply.has_value()) << target;
    EXPECT_EQ(reply->command_id(), id);
    EXPECT_EQ(reply->sender(), "me");
    EXPECT_EQ(reply->node(), "sim");
    EXPECT_TRUE(reply->accepted());
    EXPECT_EQ(reply->text(), "answer " + std::to_string(id));
  }
}

TEST(CommandServer, IsSilentAboutWhatIsForOthers) {
  Desk desk;
  for (const char* target : {"", "simulation", "keyboard", "device_node"})
    EXPECT_FALSE(desk.desk.take(command_for(target, 1)).has_value()) << target;
  EXPECT_TRUE(desk.obeyed.empty());
}

TEST(CommandServer, ObeysACommandOnceHoweverOftenItComes) {
  Desk desk;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(desk.desk.take(command_for("sim", 7))->text(), "answer 1");
  EXPECT_EQ(desk.obeyed.size(), 1u);
}

TEST(CommandServer, TellsSendersApartThatUseTheSameNumber) {
  Desk desk;
  desk.desk.take(command_for("sim", 7, "one"));
  EXPECT_EQ(desk.desk.take(command_for("sim", 7, "other"))->text(), "answer 2");
}

TEST(CommandServer, RemembersABoundedNumberOfCommands) {
  Desk desk;
  for (std::uint64_t id = 0; id <= CommandServer::kRemembered; ++id)
    desk.desk.take(command_for("sim", id));
  const std::size_t before = desk.obeyed.size();

  desk.desk.take(command_for("sim", 1));
  EXPECT_EQ(desk.obeyed.size(), before) << "still known";
  desk.desk.take(command_for("sim", 0));
  EXPECT_EQ(desk.obeyed.size(), before + 1) << "forgotten, and obeyed as a new one";
}

TEST(CommandServer, AnswersAFailureWithItsReason) {
  CommandServer desk("sim", "sim_node", [](const msg::ControlCommand&) -> Answer {
    throw std::runtime_error("no memory for it");
  });
  const auto reply = desk.take(command_for("sim", 1));
  ASSERT_TRUE(reply.has_value());
  EXPECT_FALSE(reply->accepted());
  EXPECT_EQ(reply->text(), "no memory for it");
}

}  // namespace
}  // namespace cordis::node
