// tests/mcap/take_copy_test.cpp -- parts of takes, and takes put together.
#include "record_node/mcap/take_copy.h"

#include <fstream>
#include <iterator>
#include <random>
#include <span>
#include <tuple>

#include <gtest/gtest.h>

#include "record_node/mcap/take_check.h"
#include "record_node/mcap/topic_glob.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

/// A message without the number of its channel, which a copy may change.
using Said = std::tuple<std::string, std::uint32_t, std::uint64_t, std::vector<std::byte>>;

Said said(const std::string& topic, const OwnedMessage& message) {
  return {topic, message.sequence, message.log_time_nsec, message.data};
}

std::vector<Said> all_said(const std::filesystem::path& path) {
  const Reader reader(path);
  EXPECT_EQ(reader.damage(), "");
  EXPECT_TRUE(check_take(path).faults.empty());
  std::vector<Said> list;
  for (const OwnedMessage& message : messages_of(reader))
    list.push_back(said(reader.channels().at(message.channel_id).topic, message));
  return list;
}

std::string topic_of(const RandomTake& take, const OwnedMessage& message) {
  return take.channels.at(message.channel_id - 1u).topic;
}

TEST(Cut, KeepsExactlyTheMessagesOfItsTimeAndTopics) {
  const TakeFolder folder;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    WriterConfig config;
    config.chunk_bytes = 1000 + random() % 5000;
    const auto path = folder / (std::to_string(seed) + ".mcap");
    const RandomTake take = write_random_take(path, random, config, 200, 1 + random() % 50'000'000);
    MessageFilter filter;
    filter.start_nsec = take.messages[random() % 200].log_time_nsec;
    filter.end_nsec = filter.start_nsec + random() % 300'000'000;
    if (seed % 2 == 0) filter.topics = {"topic/[02]", "*3"};
    const auto part = folder / (std::to_string(seed) + "_part.mcap");

    const Reader reader(path);
    Writer writer(part);
    EXPECT_TRUE(cut(reader, filter, writer).empty());
    ASSERT_EQ(writer.close(), WriteStatus::kOk);

    std::vector<Said> expected;
    for (const OwnedMessage& message : take.by_time()) {
      const std::string topic = topic_of(take, message);
      const bool is_wanted =
          seed % 2 != 0 || topic == "topic/0" || topic == "topic/2" || topic == "topic/3";
      if (is_wanted && message.log_time_nsec >= filter.start_nsec &&
          message.log_time_nsec <= filter.end_nsec)
        expected.push_back(said(topic, message));
    }
    EXPECT_EQ(all_said(part), expected);
    EXPECT_EQ(Reader(part).metadata(), take.metadata);
    EXPECT_TRUE(std::ranges::equal(Reader(part).attachments().front().data, take.attachment));
  }
}

TEST(Cut, BeginsWithWhatIsKeptForLateJoiners) {
  const TakeFolder folder;
  Writer whole(folder / "whole.mcap");
  const std::map<std::string, std::string> kept{{"qos", "durability: true\nkeyed: true"}};
  const std::uint16_t devices = whole.add_channel({0, 0, "device/description", "cdr", kept});
  const std::uint16_t frames = whole.add_channel({0, 0, "scene/frame", "cdr", {}});
  const auto device = [](unsigned key) {  // 4 bytes of encapsulation, then the key
    std::vector<std::byte> data(12);
    data[4] = static_cast<std::byte>(key);
    return data;
  };
  const auto say = [&whole](std::uint16_t channel, std::uint32_t sequence, std::uint64_t time,
                            const std::vector<std::byte>& data) {
    EXPECT_EQ(whole.write({channel, sequence, time, time, data}), WriteStatus::kOk);
  };
  say(devices, 1, 10, device(1));
  say(devices, 2, 20, device(1));
  say(devices, 3, 30, device(2));
  say(frames, 1, 40, {});
  say(frames, 2, 100, {});
  ASSERT_EQ(whole.close(), WriteStatus::kOk);
  MessageFilter filter;
  filter.start_nsec = 90;

  Writer part(folder / "part.mcap");
  EXPECT_TRUE(cut(Reader(folder / "whole.mcap"), filter, part).empty());
  ASSERT_EQ(part.close(), WriteStatus::kOk);

  const std::vector<Said> expected{{"device/description", 2, 90, device(1)},
                                   {"device/description", 3, 90, device(2)},
                                   {"scene/frame", 2, 100, {}}};
  EXPECT_EQ(all_said(folder / "part.mcap"), expected);
}

TEST(Merge, HasEveryMessageOfEveryTakeByTime) {
  const TakeFolder folder;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<std::unique_ptr<Reader>> readers;
    std::vector<const Reader*> sources;
    std::vector<Said> expected;
    for (unsigned i = 0; i <= seed % 4; ++i) {
      const auto path = folder / (std::to_string(seed) + "_" + std::to_string(i) + ".mcap");
      const RandomTake take = write_random_take(path, random, {}, random() % 200);
      for (const OwnedMessage& message : take.messages)
        expected.push_back(said(topic_of(take, message), message));
      readers.push_back(std::make_unique<Reader>(path));
      sources.push_back(readers.back().get());
    }

    const auto path = folder / (std::to_string(seed) + ".mcap");
    Writer writer(path);
    EXPECT_TRUE(merge(sources, writer).empty());
    ASSERT_EQ(writer.close(), WriteStatus::kOk);

    std::vector<Said> got = all_said(path);
    const auto is_earlier = [](const Said& a, const Said& b) {
      return std::get<2>(a) < std::get<2>(b);
    };
    EXPECT_TRUE(std::is_sorted(got.begin(), got.end(), is_earlier));
    std::sort(got.begin(), got.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(got, expected);
    EXPECT_EQ(Reader(path).attachments().size(), sources.size());
  }
}

/// The summary is as it was: only the messages of one chunk are damaged.
TEST(Copy, SaysWhichChunkItCouldNotRead) {
  const TakeFolder folder;
  const std::filesystem::path path = folder / "flipped.mcap";
  const std::string mark = "to be damaged";
  {
    WriterConfig config;
    config.compression = Compression::kNone;
    config.chunk_bytes = 100;
    Writer writer(path, config);
    const std::uint16_t channel = writer.add_channel({0, 0, "scene/frame", "cdr", {}});
    for (std::uint32_t i = 1; i <= 10; ++i) {
      std::string text(200, 'x');
      if (i == 5) text = mark + text;
      const auto bytes = std::as_bytes(std::span(text));
      ASSERT_EQ(writer.write({channel, i, i, i, bytes}), WriteStatus::kOk);
    }
    ASSERT_EQ(writer.close(), WriteStatus::kOk);
  }
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(file)), {});
  const std::size_t position = whole.find(mark);
  ASSERT_NE(position, std::string::npos);
  file.seekp(static_cast<std::streamoff>(position)).put('T');
  file.close();

  const Reader reader(path);
  ASSERT_TRUE(reader.is_whole());
  Writer part(folder / "part.mcap");
  EXPECT_EQ(cut(reader, {}, part).size(), 1u);
  ASSERT_EQ(part.close(), WriteStatus::kOk);
  EXPECT_EQ(Reader(folder / "part.mcap").statistics().message_count, 9u);
  Writer both(folder / "both.mcap");
  EXPECT_EQ(merge({&reader, &reader}, both).size(), 2u);
  ASSERT_EQ(both.close(), WriteStatus::kOk);
  EXPECT_EQ(Reader(folder / "both.mcap").statistics().message_count, 18u);
}

TEST(Topics, ArePatternsOverTheWholeName) {
  EXPECT_TRUE(matches_topic("scene/frame", {}));
  EXPECT_TRUE(matches_topic("scene/frame", {"x", "scene/*"}));
  EXPECT_TRUE(matches_topic("a/b/c", {"a*c"}));
  EXPECT_TRUE(matches_topic("scene/frame", {"scene/fram?"}));
  EXPECT_FALSE(matches_topic("scene/frame", {"scene"}));
  EXPECT_FALSE(matches_topic("scene/frame", {"frame", "Scene/*"}));
}

}  // namespace
}  // namespace cordis::mcap
