// tests/viz/page_text_test.cpp
#include "viz_node/page_text.h"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kNow = 50'000'000'000;

HeardNode heard(const std::string& phase, std::int64_t seconds_ago) {
  HeardNode node;
  node.status.node("sim");
  node.status.kind("sim_node");
  node.status.phase(phase);
  node.heard_nsec = kNow - seconds_ago * 1'000'000'000;
  return node;
}

std::string state_of(const HeardNode& node) {
  return Json::parse(status_text({node}, {}, {}, 0, kNow))["nodes"][0]["state"];
}

TEST(PageText, CallsANodeLostThatIsNoLongerHeardUnlessItSaidThatItStops) {
  EXPECT_EQ(state_of(heard("running", 0)), "running");
  EXPECT_EQ(state_of(heard("waiting", 1)), "waiting");
  EXPECT_EQ(state_of(heard("running", 2)), "lost");
  EXPECT_EQ(state_of(heard("stopped", 100)), "stopped");
  EXPECT_EQ(state_of(heard("failed", 100)), "failed");
}

TEST(PageText, SurvivesTextsThatAreNoUtf8AndNumbersThatAreNone) {
  HeardNode node = heard("running", 0);
  node.status.node("a\xff\"b" + std::string(10'000, 'x'));
  node.status.energy_j(std::numeric_limits<double>::quiet_NaN());

  const Json json = Json::parse(status_text({node}, {}, {}, 0, kNow));

  EXPECT_TRUE(json["nodes"][0]["energy_j"].is_null());
  EXPECT_LT(json["nodes"][0]["name"].get<std::string>().size(), 400u);
}

TEST(PageText, KeepsARunOf64BitsWhole) {
  const Json json = Json::parse(description_text(row_of_three(), 3));
  EXPECT_EQ(json["run"], "1234567890123456789");
  EXPECT_EQ(json["scene"], 3);
  EXPECT_EQ(json["link_count"], 2);
  EXPECT_EQ(json["signals"][1]["unit"], "N");
}

TEST(PageText, ReadsAnAcknowledgement) {
  const auto word = read_acknowledgement(R"({"type": "ack", "sequence": 12, "drawn": true})");
  ASSERT_TRUE(word);
  EXPECT_EQ(word->sequence, 12u);
  EXPECT_TRUE(word->drawn);
}

TEST(PageText, TakesNothingElseForAnAcknowledgement) {
  for (const char* text : {"", "{", "12", "[]", "null", R"({"type": "ack"})",
                           R"({"type": 1, "sequence": 1, "drawn": true})",
                           R"({"type": "ack", "sequence": "1", "drawn": true})",
                           R"({"type": "ack", "sequence": -1, "drawn": true})",
                           R"({"type": "ack", "sequence": 1.5, "drawn": true})",
                           R"({"type": "ack", "sequence": 4294967296, "drawn": true})",
                           R"({"type": "ack", "sequence": 1, "drawn": 1})"}) {
    EXPECT_FALSE(read_acknowledgement(text)) << text;
  }
}

}  // namespace
}  // namespace cordis::viz
