// tests/record/play_test.cpp -- `cordis play`, and `cordis ctl` on what it plays.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/record/count_take.h"
#include "tests/support/child_process.h"

namespace cordis {
namespace {

using test::ChildProcess;
using test::CountListener;
using test::kPatience;
using test::numbers;

const std::string kCordis = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

class Play : public ::testing::Test {
 protected:
  Play() { test::write_count_take(take_); }

  /// `cordis play` of the take in the domain of this test.
  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> all{kCordis, "play", take_, "--domain", domain_};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// What a verb ends with, and all that it says.
  struct Answer {
    int code = 0;
    std::string text;
  };
  Answer ask(const std::vector<std::string>& verb) const {
    std::vector<std::string> all{kCordis};
    all.insert(all.end(), verb.begin(), verb.end());
    ChildProcess program(all);
    const int code = program.wait(kPatience);
    return {code, program.output()};
  }
  Answer ctl(const std::vector<std::string>& command) const {
    std::vector<std::string> all{"ctl", "count", "--domain", domain_};
    all.insert(all.end(), command.begin(), command.end());
    return ask(all);
  }
  void accepts(const std::vector<std::string>& command, const std::string& answer) const {
    const Answer said = ctl(command);
    EXPECT_EQ(said.code, 0) << said.text;
    EXPECT_NE(said.text.find(answer), std::string::npos) << said.text;
  }

  mcap::TakeFolder folder_;
  const std::string take_ = folder_ / "take.mcap";
  const std::string domain_ = std::to_string(test::own_domain());
};

TEST_F(Play, GivesEachMessageOnceAndInOrder) {
  CountListener listener("count");
  ChildProcess player(words({"--wait-for-readers", "-r", "5"}));
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  EXPECT_TRUE(listener.receives(numbers(0, test::kCounted)));
  EXPECT_NE(player.output().find("40 messages played"), std::string::npos) << player.output();
}

TEST_F(Play, StartedPausedIsSteppedSoughtAndReset) {
  CountListener listener("count");
  ChildProcess player(words({"--wait-for-readers", "--start-paused"}));
  ASSERT_TRUE(player.wait_for_output("session 'count'", kPatience));
  std::vector<std::uint32_t> expected{0};
  accepts({"step"}, "paused at 0.000 of 0.780 s, and plays the next message");
  EXPECT_TRUE(listener.receives(expected));
  accepts({"step", "3"}, "plays 3 messages");
  expected.insert(expected.end(), {1, 2, 3});
  EXPECT_TRUE(listener.receives(expected));
  accepts({"seek", "400ms"}, "paused at 0.400 of 0.780 s");
  accepts({"step"}, "paused at 0.400");
  expected.push_back(20);
  EXPECT_TRUE(listener.receives(expected));
  accepts({"seek", "0s"}, "paused at 0.000");
  accepts({"step"}, "paused at 0.000");
  expected.push_back(0);
  EXPECT_TRUE(listener.receives(expected));

  // At its end a paused player still is there.
  accepts({"seek", "1h"}, "paused at 0.780 of 0.780 s");
  accepts({"step", "5"}, "paused at 0.780");
  expected.push_back(39);
  EXPECT_TRUE(listener.receives(expected));
  accepts({"reset"}, "paused at 0.000");
  accepts({"step"}, "paused at 0.000");  // the four steps that found no message are forgotten
  expected.push_back(0);
  EXPECT_TRUE(listener.receives(expected));

  accepts({"rate", "20"}, "20 times as fast");
  accepts({"resume"}, "goes on at");
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  const std::vector<std::uint32_t> rest = numbers(1, test::kCounted);
  expected.insert(expected.end(), rest.begin(), rest.end());
  EXPECT_TRUE(listener.receives(expected));
}

TEST_F(Play, WhileItRunsIsPausedAndRefusesWhatNoTakeCanDo) {
  ChildProcess player(words({"--loop"}));
  ASSERT_TRUE(player.wait_for_output("session 'count'", kPatience));
  accepts({"--node", "*", "pause"}, "play: paused at");
  accepts({"resume"}, "goes on at");
  accepts({"--node", "play", "rate", "0.5"}, "0.5 times as fast");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"rate", "0"},
                                                  {"rate", "fast"},
                                                  {"step", "0"},
                                                  {"step", "1.5"},
                                                  {"step", "two"},
                                                  {"load", "scene.yaml"},
                                                  {"seek", "-1s"}}) {
    const Answer refused = ctl(command);
    EXPECT_EQ(refused.code, 2) << command[0] << " " << refused.text;
    EXPECT_EQ(std::count(refused.text.begin(), refused.text.end(), '\n'), 1) << refused.text;
  }
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
}

TEST_F(Play, BeginsAgainAtTheEndUntilASignalEndsIt) {
  CountListener listener("count");
  ChildProcess player(words({"--loop", "--rate", "20", "--wait-for-readers"}));
  EXPECT_TRUE(test::eventually([&] {
    const std::vector<std::uint32_t>& numbers = listener.received();
    return std::count(numbers.begin(), numbers.end(), 0u) >= 3;
  }));
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  const std::vector<std::uint32_t>& received = listener.received();
  for (std::size_t i = 0; i < received.size(); ++i) ASSERT_EQ(received[i], i % test::kCounted) << i;
}

TEST_F(Play, GoesAsFastAsItsRateSays) {
  CountListener listener("count");
  ChildProcess player(words({"--wait-for-readers", "--rate", "0.001"}));
  ASSERT_TRUE(listener.receives({0}));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(test::eventually(
      [&] { return std::chrono::steady_clock::now() - begin > std::chrono::seconds(1); }));
  accepts({"resume"}, "goes on at 0.0");  // 0.1 s of the take are 100 s
  accepts({"rate", "1000"}, "plays 1000 times as fast");
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  EXPECT_TRUE(listener.receives(numbers(0, test::kCounted)));
}

TEST_F(Play, GivesAPartOfTheTakeUnderAnotherName) {
  CountListener listener("elsewhere", "lab/other");
  ChildProcess player(
      words({"--session", "elsewhere", "--start-offset", "210ms", "--playback-duration", "180ms",
             "-m", "lab/count:=lab/other", "--wait-for-readers"}));
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  EXPECT_TRUE(listener.receives(numbers(11, 20)));
}

TEST_F(Play, GivesWhatIsLeftOfATornTakeAndSaysSo) {
  const std::uintmax_t size = std::filesystem::file_size(take_);
  std::filesystem::resize_file(take_, size / 4);
  CountListener listener("count");
  ChildProcess player(words({"--wait-for-readers", "--rate", "10"}));
  EXPECT_EQ(player.wait(kPatience), 3) << player.output();
  EXPECT_NE(player.output().find("was not closed"), std::string::npos) << player.output();
  const std::string counted = " messages played";
  const std::size_t position = player.output().find(counted);
  ASSERT_NE(position, std::string::npos) << player.output();
  EXPECT_TRUE(test::eventually([&] { return !listener.received().empty(); }));
  EXPECT_TRUE(
      listener.receives(numbers(0, static_cast<std::uint32_t>(listener.received().back()) + 1)));
  EXPECT_LT(listener.received().size(), test::kCounted);
}

TEST_F(Play, RefusesWordsThatFitNoTakeInOneSentence) {
  struct Wrong {
    std::vector<std::string> words;
    int code;
    std::string says;
  };
  for (const Wrong& wrong :
       {Wrong{{"-m", "lab/cuont:=b"}, 1, "plays no topic 'lab/cuont'"},
        Wrong{{"-m", "lab/count"}, 2, "TOPIC:=OTHER"},
        Wrong{{"--topics", "scene/*"}, 1, "no topic fits"},
        Wrong{{"--start-offset", "10s"}, 2, "beyond the end of the take, which lasts 0.780 s"},
        Wrong{{"--start-offset", "-1s"}, 2, "0 or longer"}, Wrong{{"--rate", "0"}, 2, "above 0"}}) {
    ChildProcess player(words(wrong.words));
    EXPECT_EQ(player.wait(kPatience), wrong.code) << player.output();
    EXPECT_NE(player.output().find(wrong.says), std::string::npos) << player.output();
  }
}

/// A NodeStatus as version 2 of the messages has it, and its payload.
const std::string kOldStatus =
    "module cordis { module msg {\n"
    "enum NodeKind { KIND_SIM_NODE, KIND_DEVICE_NODE, KIND_VIZ_NODE, KIND_RECORD_NODE };\n"
    "struct NodeStatus { @key unsigned long node_id; unsigned long wire_version; string node;\n"
    "  NodeKind kind; unsigned long long epoch; };\n}; };\n";

std::vector<std::byte> old_status(std::uint8_t kind) {
  std::vector<std::byte> payload(4 + 4 + 4 + 4 + 8 + 4 + 4 + 8);
  payload[1] = std::byte{1};     // little-endian
  payload[4] = std::byte{kind};  // node_id
  payload[8] = std::byte{2};     // wire_version
  payload[12] = std::byte{5};    // length of the name
  std::memcpy(&payload[16], "node", 5);
  payload[24] = std::byte{kind};
  return payload;
}

TEST(PlayOfAnOldTake, LeavesOutItsViewersByTheSchemaThatItHolds) {
  const mcap::TakeFolder folder;
  const std::string take = folder / "old.mcap";
  mcap::Writer writer(take, {});
  const std::uint16_t schema =
      writer.add_schema({0, "cordis::msg::NodeStatus", "omgidl", kOldStatus});
  const std::uint16_t channel = writer.add_channel({.schema_id = schema,
                                                    .topic = "node/status",
                                                    .message_encoding = "cdr",
                                                    .metadata = {{"qos", R"(reliability: true
durability: true
ownership: false
)"}}});
  ASSERT_EQ(writer.add_metadata({"cordis.session", {{"session", "old"}, {"wire_version", "2"}}}),
            mcap::WriteStatus::kOk);
  for (std::uint8_t kind = 0; kind < 4; ++kind) {
    const std::uint64_t time = 1'700'000'000'000'000'000 + kind * 1'000'000u;
    ASSERT_EQ(writer.write({channel, kind, time, time, old_status(kind)}), mcap::WriteStatus::kOk);
  }
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
  ChildProcess player({kCordis, "play", take, "--domain", std::to_string(test::own_domain())});
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  EXPECT_NE(player.output().find("\n2 messages played"), std::string::npos) << player.output();
}

}  // namespace
}  // namespace cordis
