// tests/mcap/writer_reader_test.cpp -- what a writer is given is what a reader gives back.
#include <random>

#include <gtest/gtest.h>

#include "record_node/mcap/file_error.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

constexpr Compression kCompressions[] = {Compression::kNone, Compression::kLz4, Compression::kZstd};

TEST(WriterAndReader, GiveBackEveryRandomTake) {
  const TakeFolder folder;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    WriterConfig config;
    config.compression = kCompressions[seed % 3];
    config.chunk_bytes = 1 + random() % 20'000;
    config.chunk_nsec = 1 + random() % 100'000'000;
    const std::uint64_t disorder = seed % 2 == 0 ? 0 : 1 + random() % 200'000'000;
    const auto path = folder / (std::to_string(seed) + ".mcap");

    const RandomTake take = write_random_take(path, random, config, random() % 400, disorder);
    const Reader reader(path);

    EXPECT_EQ(reader.damage(), "");
    EXPECT_FALSE(std::filesystem::exists(part_of(path)));
    ASSERT_EQ(reader.schemas().size(), take.schemas.size());
    for (const Schema& schema : take.schemas) EXPECT_EQ(reader.schemas().at(schema.id), schema);
    ASSERT_EQ(reader.channels().size(), take.channels.size());
    for (const Channel& channel : take.channels)
      EXPECT_EQ(reader.channels().at(channel.id), channel);
    EXPECT_EQ(reader.metadata(), take.metadata);
    ASSERT_EQ(reader.attachments().size(), 1u);
    const Attachment& attachment = reader.attachments().front();
    EXPECT_EQ(attachment.name, "scene.yaml");
    EXPECT_TRUE(std::ranges::equal(attachment.data, take.attachment));
    EXPECT_EQ(reader.statistics().message_count, take.messages.size());
    EXPECT_EQ(messages_of(reader), take.by_time());
  }
}

/// Messages of one time stay in the order in which they were written, across chunks too.
TEST(WriterAndReader, KeepTheOrderOfMessagesOfOneTime) {
  const TakeFolder folder;
  std::mt19937 random(1);
  for (const std::uint32_t chunk_bytes : {1u, 200u}) {  // a chunk of one message, and of some
    const auto path = folder / (std::to_string(chunk_bytes) + ".mcap");
    WriterConfig config;
    config.chunk_bytes = chunk_bytes;
    Writer writer(path, config);
    RandomTake take;
    const std::uint16_t channel = writer.add_channel({0, 0, "topic", "cdr", {}});
    for (std::uint32_t i = 0; i < 100; ++i) {
      const std::uint64_t time = 1000 + random() % 3;
      take.messages.push_back({channel, i, time, time, random_bytes(random, 10)});
      ASSERT_EQ(writer.write(take.messages.back().message()), WriteStatus::kOk);
    }
    ASSERT_EQ(writer.close(), WriteStatus::kOk);

    const Reader reader(path);
    ASSERT_GT(reader.chunks().size(), 5u);
    EXPECT_EQ(messages_of(reader), take.by_time());
  }
}

TEST(Writer, NeverReplacesAFileThatCameMeanwhile) {
  const TakeFolder folder;
  const auto path = folder / "take.mcap";
  Writer writer(path);
  const std::vector<char> others{'o', 't', 'h', 'e', 'r'};
  write_file(path, others);

  EXPECT_EQ(writer.close(), WriteStatus::kFailed);

  EXPECT_NE(writer.problem().find("take.mcap"), std::string::npos) << writer.problem();
  EXPECT_EQ(contents_of(path), others);
  EXPECT_TRUE(Reader(part_of(path)).is_whole()) << "and what was recorded is kept";
}

}  // namespace
}  // namespace cordis::mcap
