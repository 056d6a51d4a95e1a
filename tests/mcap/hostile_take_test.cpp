// tests/mcap/hostile_take_test.cpp -- files that somebody made to break a reader.
#include <random>

#include <gtest/gtest.h>

#include "record_node/mcap/compression.h"
#include "record_node/mcap/crc32.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/format.h"
#include "record_node/mcap/recover.h"
#include "record_node/mcap/take_check.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

constexpr std::uint64_t kHuge = ~std::uint64_t{0};

/// Reads, checks and recovers a file in every way: none of them may crash or take all memory.
void expect_survival(const std::filesystem::path& path) {
  try {
    const Reader reader(path);
    MessageCursor cursor = reader.messages();
    for (Message message; cursor.next(message);)
      EXPECT_LE(message.data.size(), reader.size() * 300);
    static_cast<void>(check_take(path));
    static_cast<void>(recover(path));
    EXPECT_EQ(Reader(path).damage(), "");
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

/// Begins as a take does.
Bytes beginning() {
  Bytes bytes;
  append_magic(bytes);
  append_header(bytes, "hostile");
  append(bytes, Channel{1, 0, "topic", "cdr", {}});
  return bytes;
}

void expect_survival(const TakeFolder& folder, const Bytes& bytes) {
  const auto path = folder / "hostile.mcap";
  std::vector<char> contents(bytes.size());
  std::memcpy(contents.data(), bytes.data(), bytes.size());
  write_file(path, contents);
  expect_survival(path);
}

/// A chunk of these records with this size and CRC in its head.
Bytes chunk_of(const Bytes& records, std::uint64_t says_size, const std::string& compression,
               std::uint32_t crc = 0) {
  Bytes bytes = beginning();
  append(bytes, ChunkView{0, kHuge, says_size, crc, compression, records});
  return bytes;
}

TEST(HostileTake, SizesThatAreLiesAreRefused) {
  const TakeFolder folder;
  const Bytes nothing;
  const Bytes some(100, std::byte{7});
  for (const std::uint64_t size :
       {std::uint64_t{0}, std::uint64_t{99}, std::uint64_t{1} << 40, kHuge}) {
    for (const char* compression : {"", "lz4", "zstd", "lzma", "none"}) {
      expect_survival(folder, chunk_of(some, size, compression));
      expect_survival(folder, chunk_of(nothing, size, compression));
    }
  }
}

TEST(HostileTake, ASmallChunkThatUnpacksToMuchIsRefused) {
  const TakeFolder folder;
  for (const Compression compression : {Compression::kLz4, Compression::kZstd}) {
    Compressor compressor(compression);
    Bytes packed;
    ASSERT_TRUE(compressor.compress(Bytes(kMaxChunkSize + 1), packed));
    ASSERT_LT(packed.size(), kMaxChunkSize / 100);
    const Bytes bytes = chunk_of(packed, kMaxChunkSize + 1, name_of(compression));
    expect_survival(folder, bytes);
    expect_survival(folder, chunk_of(packed, 1000, name_of(compression)));
  }
}

TEST(HostileTake, LengthsBeyondTheFileAreRefused) {
  const TakeFolder folder;
  for (unsigned opcode = 0; opcode < 256; ++opcode) {
    for (const std::uint64_t length : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 31,
                                       std::uint64_t{1} << 63, kHuge, kHuge - 8}) {
      Bytes bytes = beginning();
      ByteWriter writer(bytes);
      writer.number(static_cast<std::uint8_t>(opcode));
      writer.number(length);
      expect_survival(folder, bytes);
      for (int i = 0; i < 60; ++i) writer.number(std::uint8_t{0xFF});
      expect_survival(folder, bytes);
    }
  }
}

TEST(HostileTake, ChunksInChunksAndUnknownChannelsAreRefused) {
  const TakeFolder folder;
  Bytes inner = chunk_of(Bytes(50), 50, "");
  expect_survival(folder, chunk_of(inner, inner.size(), "", crc32(inner)));
  Bytes message;
  append(message, Message{9, 0, 0, 0, {}});
  expect_survival(folder, chunk_of(message, message.size(), "", crc32(message)));
}

TEST(HostileTake, ASummaryThatPointsAnywhereIsNotFollowed) {
  const TakeFolder folder;
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    const auto any = [&random] {
      const std::uint64_t places[] = {0, 8, 50, 300, kHuge, random()};
      return places[random() % std::size(places)];
    };
    Bytes bytes = beginning();
    Summary summary;
    summary.channels[1] = {1, 0, "topic", "cdr", {}};
    summary.statistics.message_count = any();
    for (int i = 0; i < 3; ++i) {
      summary.chunks.push_back({any(), any(), any(), any(), {{1, any()}}, any(), "", any(), any()});
      summary.attachments.push_back({any(), any(), 0, 0, any(), "name", "type"});
      summary.metadata.push_back({any(), any(), "name"});
    }
    if (round % 2 == 0) summary.attachments.clear();
    if (round % 3 == 0) summary.metadata.clear();
    append_end(bytes, summary, bytes.size(), 0);
    expect_survival(folder, bytes);
  }
}

TEST(HostileTake, RandomBytesInTheMiddleOfATakeDoNotBreakIt) {
  const TakeFolder folder;
  const auto path = folder / "noise.mcap";
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    WriterConfig config;
    config.compression = static_cast<Compression>(seed % 3);
    config.chunk_bytes = 2000;
    std::filesystem::remove(path);
    write_random_take(path, random, config, 60);
    std::vector<char> bytes = contents_of(path);
    for (std::size_t i = 1 + random() % 20; i > 0; --i) {
      const std::size_t place = 8 + random() % (bytes.size() - 8);
      const std::size_t length = std::min<std::size_t>(1 + random() % 12, bytes.size() - place);
      for (std::size_t k = 0; k < length; ++k)
        bytes[place + k] = static_cast<char>(random() % 3 == 0 ? 0xFF : random());
    }
    write_file(path, bytes);
    expect_survival(path);
  }
}

}  // namespace
}  // namespace cordis::mcap
