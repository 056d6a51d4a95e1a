// tests/record/missed_test.cpp -- messages that a recorder misses are counted.
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "record_node/mcap/reader.h"
#include "tests/record/count_take.h"
#include "tests/support/child_process.h"

namespace cordis {
namespace {

using test::ChildProcess;
using test::kPatience;

const std::string kMissedCordis = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

/// True if a take that is still written holds a message that follows a gap.
bool holds_gap(const std::filesystem::path& part) {
  const mcap::Reader reader(part);
  mcap::MessageCursor cursor = reader.messages();
  std::uint32_t last = 0;
  for (mcap::Message message; cursor.next(message); last = message.sequence)
    if (last != 0 && message.sequence > last + 1) return true;
  return false;
}

/// Plays a take again and again, and records it with a recorder that stops meanwhile.
/// @param code  how the recorder ends. @param sentence  what it says then
/// @return `cordis info --json` of its take
nlohmann::json info_of_gap(const mcap::TakeFolder& folder, const std::string& topic,
                           bool is_exclusive, int code, const std::string& sentence) {
  const std::string domain = std::to_string(test::own_domain());
  const std::string played = folder / "played.mcap";
  const std::string take = folder / "take.mcap";
  test::write_count_take(played, is_exclusive, topic);
  ChildProcess player({kMissedCordis, "play", played, "--loop", "--rate", "200", "--session",
                       "missed", "--domain", domain});
  EXPECT_TRUE(player.wait_for_output("session 'missed'", kPatience));
  test::CountListener listener("missed", topic);
  const auto wait_for_more = [&](std::size_t count) {
    const std::size_t end = listener.received().size() + count;
    return test::eventually([&] { return listener.received().size() >= end; });
  };
  EXPECT_TRUE(wait_for_more(500)) << player.output();

  ChildProcess recorder(
      {kMissedCordis, "record", "missed", "--domain", domain, "--topics", topic, "-o", take});
  EXPECT_TRUE(recorder.wait_for_output("records into", kPatience));
  EXPECT_TRUE(test::eventually([&] {
    std::error_code absent;
    const auto size = std::filesystem::file_size(take + ".part", absent);
    return !absent && size > 3000;
  }));
  recorder.signal(SIGSTOP);
  EXPECT_TRUE(wait_for_more(30000));  // more than DDS keeps and sockets hold
  recorder.signal(SIGCONT);
  // What sockets held comes first: a busy machine takes seconds to get past it.
  EXPECT_TRUE(test::eventually([&] { return holds_gap(take + ".part"); })) << recorder.output();
  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(kPatience), code) << recorder.output();
  EXPECT_NE(recorder.output().find(sentence), std::string::npos) << recorder.output();
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();

  ChildProcess info({kMissedCordis, "info", take, "--json"});
  EXPECT_EQ(info.wait(kPatience), code);
  return nlohmann::json::parse(info.output());
}

class RecorderThatStops : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(, RecorderThatStops, ::testing::Bool(), [](const auto& exclusive) {
  return exclusive.param ? "ExclusiveTopic" : "SharedTopic";
});

TEST_P(RecorderThatStops, CountsWhatItMissesInTheTake) {
  const mcap::TakeFolder folder;
  const nlohmann::json json = info_of_gap(folder, "lab/count", GetParam(), 3, "lost on the way");
  const auto missed = json["missed"];
  EXPECT_GT(missed["lost"], 1000);
  EXPECT_GT(missed["before"], 0);
  EXPECT_EQ(missed["dropped"], 0);
  const auto words = json["metadata"]["cordis.recording"];
  EXPECT_EQ(words["lost lab/count"], std::to_string(missed["lost"].get<std::uint64_t>()));
  // Every number of the writer is in one of the three counts.
  const mcap::Reader reader(folder / "take.mcap");
  mcap::MessageCursor cursor = reader.messages();
  std::uint32_t last = 0;
  for (mcap::Message message; cursor.next(message);) last = message.sequence;
  EXPECT_EQ(last, missed["before"].get<std::uint64_t>() + missed["lost"].get<std::uint64_t>() +
                      reader.statistics().message_count);
}

TEST(MissedMessages, OfAReplacingTopicAreNoLossToTheRecorderNorToItsTake) {
  const mcap::TakeFolder folder;
  const nlohmann::json json =
      info_of_gap(folder, "scene/frame", false, 0, "replaced by newer ones");
  const auto missed = json["missed"];
  EXPECT_GT(missed["lost"], 0);
  EXPECT_EQ(missed["lost"], missed["replaced"]);
}

/// The end of `cordis info` on a take whose recorder has missed so many messages.
void expect_info(const mcap::Metadata& missed, int code, const std::string& line) {
  const mcap::TakeFolder folder;
  const std::string take = folder / "take.mcap";
  mcap::Writer writer(take, {});
  ASSERT_EQ(writer.add_metadata(missed), mcap::WriteStatus::kOk);
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
  ChildProcess info({kMissedCordis, "info", take});
  EXPECT_EQ(info.wait(kPatience), code) << info.output();
  EXPECT_NE(info.output().find(line), std::string::npos) << info.output();
}

TEST(MissedMessages, FramesThatNewerOnesReplaceAreNoLoss) {
  expect_info({"cordis.recording", {{"messages_lost", "3"}, {"lost scene/frame", "3"}}}, 0,
              "\n3 messages replaced by newer ones");
  expect_info({"cordis.recording",
               {{"messages_lost", "4"}, {"lost scene/frame", "3"}, {"lost scene/signals", "1"}}},
              3, "\n1 message lost on the way\n3 messages replaced by newer ones");
}

}  // namespace
}  // namespace cordis
