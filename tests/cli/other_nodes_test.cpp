// tests/cli/other_nodes_test.cpp -- what a launcher says of the nodes that another one starts.
#include "cli/run/other_nodes.h"

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

using namespace std::chrono_literals;
using Sentences = std::vector<std::string>;

const OtherNodes::Time kLaunched{};

msg::NodeStatus other_status(const std::string& node, msg::NodePhase phase) {
  msg::NodeStatus status;
  status.node(node);
  status.host("studio (10.0.0.2)");
  status.phase(phase);
  return status;
}

OtherNodes a_keyboard_and_a_view() {
  return {{{"keyboard", true}, {"view", false}}, "duo.yaml", kLaunched};
}

TEST(OtherNodes, NamesThoseThatAreRequiredAndMissingOnce) {
  OtherNodes others = a_keyboard_and_a_view();

  EXPECT_EQ(others.update(kLaunched + 4s), Sentences{});
  EXPECT_EQ(
      others.update(kLaunched + 5s),
      Sentences{
          "no launcher has started keyboard yet: start the rest with `cordis run duo.yaml --only "
          "keyboard`, here or on another host"});
  EXPECT_EQ(others.update(kLaunched + 60s), Sentences{});
}

TEST(OtherNodes, SaysWhereEachRunsAndWhenItEnds) {
  OtherNodes others = a_keyboard_and_a_view();

  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_WAITING), kLaunched + 1s),
            "keyboard runs on studio (10.0.0.2)");
  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_RUNNING), kLaunched + 2s),
            std::nullopt);
  EXPECT_EQ(others.take(other_status("sim", msg::PHASE_RUNNING), kLaunched + 2s), std::nullopt)
      << "it is not of these";
  EXPECT_EQ(others.update(kLaunched + 5s), Sentences{}) << "the view is not required";
  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_STOPPED), kLaunched + 6s),
            "keyboard has ended on studio (10.0.0.2)");
  EXPECT_EQ(others.update(kLaunched + 60s), Sentences{}) << "it has said that it ends";
}

TEST(OtherNodes, SaysWhenOneFallsSilentAndWhenItIsBack) {
  OtherNodes others = a_keyboard_and_a_view();
  others.take(other_status("view", msg::PHASE_RUNNING), kLaunched + 1s);
  others.take(other_status("keyboard", msg::PHASE_RUNNING), kLaunched + 1s);
  others.take(other_status("view", msg::PHASE_RUNNING), kLaunched + 5s);

  EXPECT_EQ(others.update(kLaunched + 6s - 1ms), Sentences{});
  EXPECT_EQ(others.update(kLaunched + 6s),
            Sentences{"keyboard: no status for 5 s; its process, its host or the network is gone"});
  EXPECT_EQ(others.update(kLaunched + 7s), Sentences{});
  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_LOST), kLaunched + 8s),
            "keyboard is back on studio (10.0.0.2)");
}

TEST(OtherNodes, TakesTheLastStatusOfAnEarlierLifeForNoLife) {
  OtherNodes others = a_keyboard_and_a_view();
  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_STOPPED), kLaunched), std::nullopt);
  EXPECT_EQ(others.take(other_status("keyboard", msg::PHASE_RUNNING), kLaunched + 1s),
            "keyboard runs on studio (10.0.0.2)");
}

}  // namespace
}  // namespace cordis::cli
