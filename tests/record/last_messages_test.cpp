// tests/record/last_messages_test.cpp
#include "record_node/last_messages.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record_node/mcap/writer.h"
#include "tests/mcap/take_folder.h"

namespace cordis::record {
namespace {

constexpr std::uint64_t kPeriodNsec = 10'000'000;

/// A take with 100 chunks of 10 messages of each channel.
class LastMessagesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    mcap::Writer writer(path_);
    const auto add = [&](const std::string& topic) {
      mcap::Channel channel;
      channel.topic = topic;
      channel.message_encoding = "cdr";
      return writer.add_channel(channel);
    };
    inputs_ = add("scene/inputs");
    status_ = add("node/status");
    description_ = add("scene/description");
    const auto write = [&](std::uint16_t channel, std::uint8_t key, std::uint8_t value,
                           std::uint64_t time) {
      const std::array<std::byte, 9> data{
          {{}, {}, {}, {}, std::byte{1}, {}, {}, std::byte{key}, std::byte{value}}};
      mcap::Message message;
      message.channel_id = channel;
      message.log_time_nsec = time;
      message.data = data;
      ASSERT_EQ(writer.write(message), mcap::WriteStatus::kOk);
    };
    write(description_, 7, 1, kStart);
    for (std::uint64_t n = 0; n < 1000; ++n) {
      const auto value = static_cast<std::uint8_t>(n % 250);
      write(inputs_, 0, value, kStart + n * kPeriodNsec);
      write(status_, static_cast<std::uint8_t>(n % 2), value, kStart + n * kPeriodNsec);
      if (n % 10 == 9) {
        ASSERT_EQ(writer.flush(), mcap::WriteStatus::kOk);
      }
    }
    ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
  }

  static int value(const std::vector<std::byte>& data) { return std::to_integer<int>(data.at(8)); }

  static constexpr std::uint64_t kStart = 1'000'000'000'000;
  mcap::TakeFolder folder_;
  std::filesystem::path path_ = folder_ / "take.mcap";
  std::uint16_t inputs_ = 0;
  std::uint16_t status_ = 0;
  std::uint16_t description_ = 0;
  std::vector<std::string> problems_;
};

TEST_F(LastMessagesTest, GivesTheNewestOfEachKey) {
  const mcap::Reader take(path_);

  const LastMessages last = last_of_each_key(take, {"node/status", "scene/description"}, 0,
                                             kStart + 500 * kPeriodNsec, problems_);

  ASSERT_EQ(last.size(), 3u);
  std::vector<int> values;
  for (const auto& [place, newest] : last) values.push_back(value(newest.front()));
  EXPECT_EQ(values, (std::vector<int>{500 % 250, 499 % 250, 1}));
}

TEST_F(LastMessagesTest, GivesTheNewestOfATopicOldestFirst) {
  const mcap::Reader take(path_);
  for (const std::uint64_t newest : {0, 20, 63, 64, 65, 500, 999}) {
    SCOPED_TRACE(newest);
    const LastMessages last =
        last_of_topic(take, "scene/inputs", 64, kStart + newest * kPeriodNsec, problems_);

    ASSERT_EQ(last.size(), 1u);
    const auto& messages = last.begin()->second;
    ASSERT_EQ(messages.size(), std::min<std::uint64_t>(newest + 1, 64));
    for (std::size_t i = 0; i < messages.size(); ++i)
      ASSERT_EQ(value(messages[i]), static_cast<int>((newest + 1 - messages.size() + i) % 250));
  }
  EXPECT_TRUE(last_of_topic(take, "gesture/positions", 64, kStart, problems_).empty());
  EXPECT_TRUE(problems_.empty());
}

TEST_F(LastMessagesTest, ReadsNoChunkThatLiesFarBack) {
  {
    const mcap::Reader take(path_);
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(take.chunks().front().offset) + 60);
    file << "damaged by the test";
  }
  const mcap::Reader take(path_);
  ASSERT_TRUE(take.is_whole()) << take.damage();
  EXPECT_EQ(last_of_topic(take, "scene/inputs", 64, kStart + 20 * kPeriodNsec, problems_).size(),
            1u);
  ASSERT_EQ(problems_.size(), 1u) << "the first chunk is damaged";

  last_of_topic(take, "scene/inputs", 64, kStart + 999 * kPeriodNsec, problems_);

  EXPECT_EQ(problems_.size(), 1u);
}

}  // namespace
}  // namespace cordis::record
