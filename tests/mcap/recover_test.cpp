// tests/mcap/recover_test.cpp -- files that were cut, or of which a bit has flipped.
#include "record_node/mcap/recover.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <set>
#include <span>

#include <gtest/gtest.h>

#include "record_node/mcap/chunk_contents.h"
#include "record_node/mcap/crc32.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/format.h"
#include "record_node/mcap/take_check.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

constexpr Compression kPackings[] = {Compression::kNone, Compression::kLz4, Compression::kZstd};

/// A take of about 30 chunks, its contents and where its chunks end.
struct Original {
  RandomTake take;
  std::vector<char> bytes;
  std::vector<ChunkIndex> chunks;
  std::vector<std::uint64_t> messages_of_chunk;

  Original(const TakeFolder& folder, unsigned seed) {
    std::mt19937 random(seed);
    WriterConfig config;
    config.compression = kPackings[seed % 3];
    config.chunk_bytes = 3000;
    const auto path = folder / "original.mcap";
    take = write_random_take(path, random, config, 500);
    bytes = contents_of(path);
    const Reader reader(path);
    chunks = reader.chunks();
    for (const ChunkIndex& chunk : chunks) {
      MessageFilter filter;
      filter.start_nsec = chunk.start_nsec;
      filter.end_nsec = chunk.end_nsec;
      messages_of_chunk.push_back(messages_of(reader, filter).size());
    }
    std::filesystem::remove(path);
  }

  /// Messages of the chunks that lie wholly before a place.
  std::uint64_t messages_before(std::uint64_t place) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      if (chunks[i].offset + chunks[i].length <= place) count += messages_of_chunk[i];
    }
    return count;
  }
};

/// Expects that `some` are messages of `all`, in order.
void expect_part_of(const std::vector<OwnedMessage>& some, const std::vector<OwnedMessage>& all) {
  auto next = all.begin();
  for (const OwnedMessage& message : some) {
    next = std::find(next, all.end(), message);
    ASSERT_NE(next, all.end()) << "message " << message.sequence << " was never written";
    ++next;
  }
}

TEST(Recover, KeepsEveryWholeChunkOfACutFile) {
  const TakeFolder folder;
  const auto path = folder / "cut.mcap";
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Original original(folder, seed);
    ASSERT_GT(original.chunks.size(), 15u);
    std::mt19937 random(seed);
    std::set<std::size_t> cuts;
    while (cuts.size() < 70) cuts.insert(kMagic.size() + random() % (original.bytes.size() - 8));
    std::size_t kept_before = 0;
    for (const std::size_t cut : cuts) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", cut at " + std::to_string(cut));
      std::vector<char> torn(original.bytes.begin(),
                             original.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
      write_file(path, torn);

      const Reader before(path);
      EXPECT_FALSE(before.is_whole());
      const std::vector<OwnedMessage> readable = messages_of(before);
      const Recovery recovery = recover(path);

      const Reader after(path);
      EXPECT_EQ(after.damage(), "");
      const std::vector<OwnedMessage> kept = messages_of(after);
      EXPECT_EQ(kept, readable);
      EXPECT_EQ(kept.size(), original.messages_before(cut));
      EXPECT_EQ(kept.size(), recovery.statistics.message_count);
      EXPECT_GE(kept.size(), kept_before);  // more of the file never gives fewer messages
      expect_part_of(kept, original.take.messages);
      const TakeCheck check = check_take(path);
      EXPECT_TRUE(check.faults.empty()) << check.faults.front().text;
      EXPECT_TRUE(recover(path).was_whole);
      kept_before = kept.size();
    }
  }
}

TEST(Recover, KeepsEveryChunkThatAFlippedBitLeavesWhole) {
  const TakeFolder folder;
  const auto path = folder / "flipped.mcap";
  std::size_t losses = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Original original(folder, seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 70; ++i) {
      std::vector<char> flipped = original.bytes;
      const std::size_t place = random() % flipped.size();
      flipped[place] = static_cast<char>(flipped[place] ^ (1 << random() % 8));
      SCOPED_TRACE("seed " + std::to_string(seed) + ", byte " + std::to_string(place));
      write_file(path, flipped);

      EXPECT_FALSE(check_take(path).faults.empty());
      static_cast<void>(messages_of(Reader(path)));
      const Recovery recovery = recover(path);

      const Reader after(path);
      EXPECT_EQ(after.damage(), "");
      const std::vector<OwnedMessage> kept = messages_of(after);
      expect_part_of(kept, original.take.messages);
      std::uint64_t lost = 0;  // with the chunk in which the bit lies
      for (std::size_t k = 0; k < original.chunks.size(); ++k) {
        const ChunkIndex& chunk = original.chunks[k];
        if (place >= chunk.offset && place < chunk.offset + chunk.length)
          lost = original.messages_of_chunk[k];
      }
      EXPECT_GE(kept.size() + lost, original.take.messages.size());
      EXPECT_TRUE(recovery.has_loss() || kept.size() == original.take.messages.size());
      losses += kept.size() < original.take.messages.size() ? 1 : 0;
      const TakeCheck check = check_take(path);
      EXPECT_TRUE(check.faults.empty()) << check.faults.front().text;
    }
  }
  EXPECT_GT(losses, 50u);  // most bits lie in chunks
}

TEST(Check, FindsAFlippedBitInTheRecordsBeforeTheFirstChunk) {
  const TakeFolder folder;
  const auto path = folder / "flipped.mcap";
  for (unsigned seed = 5; seed <= 7; ++seed) {
    const Original original(folder, seed);
    std::mt19937 random(seed);
    ASSERT_GT(original.chunks.front().offset, 100u);
    for (std::size_t place = 0; place < original.chunks.front().offset;
         place += 1 + random() % 20) {
      std::vector<char> flipped = original.bytes;
      flipped[place] = static_cast<char>(flipped[place] ^ (1 << random() % 8));
      write_file(path, flipped);
      EXPECT_FALSE(check_take(path).faults.empty()) << "seed " << seed << ", byte " << place;
    }
  }
}

/// A take without a summary, whose first chunk has the index of one of its channels alone, `times`
/// times behind the last chunk.
std::vector<char> with_one_moved_index(const Original& original, int times) {
  const ChunkIndex& first = original.chunks.front();
  const ChunkIndex& last = original.chunks.back();
  const auto part = [&original](std::uint64_t begin, std::uint64_t end) {
    return std::vector<char>(original.bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                             original.bytes.begin() + static_cast<std::ptrdiff_t>(end));
  };
  const std::uint64_t first_end = first.offset + first.length;
  const std::uint64_t last_end = last.offset + last.length + last.message_index_length;
  std::vector<char> bytes = part(0, first_end);
  const std::vector<char> others = part(first_end + first.message_index_length, last_end);
  bytes.insert(bytes.end(), others.begin(), others.end());
  std::vector<std::uint64_t> places;
  for (const auto& [channel, place] : first.message_index_offsets) places.push_back(place);
  std::sort(places.begin(), places.end());
  const std::vector<char> moved = part(places.at(0), places.at(1));
  for (int i = 0; i < times; ++i) bytes.insert(bytes.end(), moved.begin(), moved.end());
  return bytes;
}

TEST(Recover, MakesATakeWholeOfWhichOneIndexWasMovedBefore) {
  const TakeFolder folder;
  const auto path = folder / "moved.mcap";
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const int times : {1, 2, 3}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(times) + " times");
      const Original original(folder, seed);
      ASSERT_GT(original.chunks.front().message_index_offsets.size(), 1u);
      write_file(path, with_one_moved_index(original, times));

      recover(path);

      const Reader after(path);
      EXPECT_TRUE(after.is_whole()) << after.damage();
      EXPECT_EQ(messages_of(after), original.take.messages);
      EXPECT_TRUE(check_take(path).faults.empty());
      EXPECT_TRUE(recover(path).was_whole);
    }
  }
}

/// A reader that looks for a time passes over a chunk whose record says another one.
TEST(Recover, GivesAChunkTheTimesOfItsMessages) {
  for (const std::uint32_t chunk_bytes : {1u, 3000u}) {  // a chunk of one message, and of many
    const TakeFolder folder;
    std::mt19937 random(7);
    WriterConfig config;
    config.chunk_bytes = chunk_bytes;
    const auto path = folder / "take.mcap";
    write_random_take(path, random, config, 60);
    std::vector<char> bytes = contents_of(path);
    const std::vector<ChunkIndex> chunks = Reader(path).chunks();
    ASSERT_GT(chunks.size(), 2u);
    constexpr std::size_t kHead = 1 + 8;  // of a record, before its start and end
    for (const std::size_t field : {std::size_t{0}, std::size_t{8}}) {
      std::vector<char> changed = bytes;
      const std::uint64_t wrong = 12345;
      std::memcpy(changed.data() + chunks[1].offset + kHead + field, &wrong, sizeof wrong);
      write_file(path, changed);
      const TakeCheck check = check_take(path);
      const bool is_reported = std::ranges::any_of(check.faults, [](const Fault& fault) {
        return fault.text == "chunk: its times are not those of its messages";
      });
      EXPECT_TRUE(is_reported) << chunk_bytes << " " << field;

      recover(path);

      EXPECT_TRUE(check_take(path).faults.empty());
      EXPECT_EQ(Reader(path).chunks()[1].start_nsec, chunks[1].start_nsec);
      EXPECT_EQ(Reader(path).chunks()[1].end_nsec, chunks[1].end_nsec);
    }
  }
}

TEST(Recover, MakesATakeWholeWhoseIndexIsWrittenTwice) {
  const TakeFolder folder;
  const auto path = folder / "twice.mcap";
  std::filesystem::copy_file(CORDIS_MCAP_CORPUS "/index_written_twice", path);

  recover(path);

  EXPECT_EQ(Reader(path).damage(), "");
  const TakeCheck check = check_take(path);
  EXPECT_TRUE(check.faults.empty()) << check.faults.front().text;
  EXPECT_TRUE(recover(path).was_whole);
}

/// Descriptions outside the chunks that all say the same, and a chunk that says otherwise.
TEST(Recover, RemovesEveryDescriptionThatAChunkSaysOtherwise) {
  const TakeFolder folder;
  const auto path = folder / "otherwise.mcap";
  for (std::size_t count = 1; count <= 4; ++count) {
    SCOPED_TRACE(count);
    const Schema schema{1, "T", "omgidl", "struct T { long a; };"};
    const Channel channel{1, 1, "a", "cdr", {}};
    Bytes records;
    append(records, schema);
    append(records, channel);
    append(records, Message{1, 0, 5, 5, {}});
    Bytes bytes;
    append_magic(bytes);
    append_header(bytes, "test");
    for (std::size_t i = 0; i < count; ++i) append(bytes, Schema{1, "U", "omgidl", ""});
    for (std::size_t i = 0; i < count; ++i) append(bytes, Channel{1, 1, "b", "cdr", {}});
    append(bytes, ChunkView{5, 5, records.size(), crc32(records), "", records});
    std::vector<char> contents(bytes.size());
    std::memcpy(contents.data(), bytes.data(), bytes.size());
    write_file(path, contents);

    const Recovery recovery = recover(path);

    EXPECT_EQ(recovery.damages.size(), 2 * count);
    EXPECT_FALSE(recovery.has_loss());
    const Reader reader(path);
    EXPECT_EQ(reader.damage(), "");
    EXPECT_EQ(messages_of(reader).size(), 1u);
    EXPECT_EQ(reader.channels().at(1), channel);
    EXPECT_TRUE(check_take(path).faults.empty());
  }
}

/// A chunk has a CRC, a description behind it has none.
TEST(Recover, KeepsTheDescriptionOfAChunkBeforeOneBehindIt) {
  const TakeFolder folder;
  const auto path = folder / "behind.mcap";
  const Schema schema{1, "T", "omgidl", "struct T { long a; };"};
  const Channel channel{1, 1, "a", "cdr", {}};
  Bytes bytes;
  append_magic(bytes);
  append_header(bytes, "test");
  append(bytes, schema);
  append(bytes, channel);
  for (const std::uint64_t time : {5, 6}) {
    Bytes records;
    append(records, schema);
    append(records, channel);
    append(records, Message{1, 0, time, time, {}});
    append(bytes, ChunkView{time, time, records.size(), crc32(records), "", records});
    append(bytes, Schema{1, "U", "omgidl", ""});
    append(bytes, Channel{1, 1, "b", "cdr", {}});
  }
  std::vector<char> contents(bytes.size());
  std::memcpy(contents.data(), bytes.data(), bytes.size());
  write_file(path, contents);

  recover(path);

  const Reader reader(path);
  EXPECT_EQ(reader.damage(), "");
  EXPECT_EQ(reader.schemas().at(1), schema);
  EXPECT_EQ(reader.channels().at(1), channel);
  EXPECT_EQ(messages_of(reader).size(), 2u);
  EXPECT_TRUE(check_take(path).faults.empty());
}

/// A chunk with messages of a channel that is described, and of one whose description is nowhere.
TEST(Recover, KeepsMessagesOfAChannelThatNothingDescribes) {
  const TakeFolder folder;
  const auto path = folder / "nowhere.mcap";
  for (const bool is_described_later : {false, true}) {
    Bytes records;
    append(records, Message{1, 0, 5, 5, {}});
    append(records, Message{2, 0, 6, 6, {}});
    Bytes bytes;
    append_magic(bytes);
    append_header(bytes, "test");
    append(bytes, Channel{1, 0, "a", "cdr", {}});
    append(bytes, ChunkView{5, 6, records.size(), crc32(records), "", records});
    if (is_described_later) append(bytes, Channel{2, 0, "b", "cdr", {}});
    std::vector<char> contents(bytes.size());
    std::memcpy(contents.data(), bytes.data(), bytes.size());
    write_file(path, contents);

    const Recovery recovery = recover(path);

    EXPECT_FALSE(recovery.has_loss());
    const Reader reader(path);
    EXPECT_EQ(reader.damage(), "");
    EXPECT_EQ(messages_of(reader).size(), 2u);
    EXPECT_EQ(reader.channels().at(2).topic, is_described_later ? "b" : "lost_channel_2");
    EXPECT_TRUE(check_take(path).faults.empty());
    EXPECT_TRUE(recover(path).was_whole);
  }
}

TEST(Recover, MakesTakesOfTheCorpusWhole) {
  const TakeFolder folder;
  const auto path = folder / "found.mcap";
  for (const auto& entry : std::filesystem::directory_iterator(CORDIS_MCAP_CORPUS)) {
    SCOPED_TRACE(entry.path());
    std::filesystem::remove(path);
    std::filesystem::copy_file(entry.path(), path);
    std::uint64_t before = 0;
    try {
      before = messages_of(Reader(path)).size();
      recover(path);
    } catch (const FileError&) {
      continue;
    }
    EXPECT_EQ(Reader(path).damage(), "");
    EXPECT_GE(messages_of(Reader(path)).size(), before);
  }
}

/// A take whose summary lists the indexes of its chunks in the opposite order: the format allows any.
std::vector<char> with_last_chunk_first(const std::vector<char>& take) {
  const auto file = std::as_bytes(std::span(take));
  const auto last = file.last(kFooterSize + kMagic.size());
  const std::uint64_t begin = parse_footer(first_record(last)->content).value().summary_start;
  const auto summary = file.subspan(begin, file.size() - last.size() - begin);
  std::vector<char> reversed;
  std::uint64_t first = 0;
  for_each_record(summary, [&](const Record& record, std::uint64_t offset) {
    if (record.opcode != Opcode::kChunkIndex) return true;
    if (reversed.empty()) first = begin + offset;
    const auto here = take.begin() + static_cast<std::ptrdiff_t>(begin + offset);
    reversed.insert(reversed.begin(), here, here + static_cast<std::ptrdiff_t>(record.size()));
    return true;
  });
  std::vector<char> bytes = take;
  std::ranges::copy(reversed, bytes.begin() + static_cast<std::ptrdiff_t>(first));
  const auto no_crc = bytes.end() - static_cast<std::ptrdiff_t>(kMagic.size() + 4);
  std::fill_n(no_crc, 4, '\0');
  return bytes;
}

/// A chunk gets the code of a record of others, and a length that covers the chunks after it, up to the
/// beginning of another one.
TEST(Recover, KeepsChunksThatARecordOfOthersSeemsToCover) {
  const TakeFolder folder;
  const auto path = folder / "covered.mcap";
  const Original original(folder, 2);
  const std::vector<char> reversed = with_last_chunk_first(original.bytes);
  write_file(path, reversed);
  ASSERT_TRUE(check_take(path).faults.empty());
  const auto recovers = [&](std::vector<char> bytes, unsigned opcode) {
    const std::uint64_t begin = original.chunks[3].offset;
    const std::uint64_t length = original.chunks[9].offset - begin - kRecordHead;
    bytes[begin] = static_cast<char>(opcode);
    std::memcpy(bytes.data() + begin + 1, &length, sizeof length);
    write_file(path, bytes);

    const Recovery recovery = recover(path);

    EXPECT_FALSE(recovery.was_whole);
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < original.chunks.size(); ++i)
      expected += i == 3 ? 0 : original.messages_of_chunk[i];
    EXPECT_EQ(recovery.statistics.message_count, expected) << "opcode " << opcode;
    expect_part_of(messages_of(Reader(path)), original.take.messages);
    EXPECT_TRUE(check_take(path).faults.empty());
  };
  for (const unsigned opcode : {0x80U, 0x81U, 0xffU}) {
    recovers(original.bytes, opcode);
    recovers(reversed, opcode);
  }
}

TEST(Recover, KeepsChunksAfterAnEndOfTheDataThatIsNone) {
  const TakeFolder folder;
  const auto path = folder / "ended.mcap";
  const Original original(folder, 3);
  std::vector<char> bytes = original.bytes;
  const std::uint64_t length = 4;
  bytes[original.chunks[3].offset] = static_cast<char>(Opcode::kDataEnd);
  std::memcpy(bytes.data() + original.chunks[3].offset + 1, &length, sizeof length);
  write_file(path, bytes);

  const Recovery recovery = recover(path);

  const std::uint64_t all = original.take.messages.size();
  EXPECT_EQ(recovery.statistics.message_count, all - original.messages_of_chunk[3]);
  expect_part_of(messages_of(Reader(path)), original.take.messages);
  EXPECT_TRUE(check_take(path).faults.empty());
}

TEST(Recover, GivesATakeItsNameAndLeavesAWholeOneAlone) {
  const TakeFolder folder;
  std::mt19937 random(7);
  const auto path = folder / "take.mcap";
  write_random_take(path, random, {}, 100);
  const std::vector<char> whole = contents_of(path);

  EXPECT_TRUE(recover(path).was_whole);
  EXPECT_EQ(contents_of(path), whole);

  std::filesystem::rename(path, part_of(path));
  EXPECT_EQ(recover(part_of(path)).path, path);
  EXPECT_EQ(contents_of(path), whole);
}

TEST(Recover, RefusesAFileThatIsBeingRecorded) {
  const TakeFolder folder;
  const auto path = folder / "live.mcap";
  Writer writer(path);

  EXPECT_THROW(recover(part_of(path)), FileError);
  EXPECT_EQ(writer.close(), WriteStatus::kOk);
  EXPECT_TRUE(recover(path).was_whole);
}

TEST(Recover, RefusesWhatIsNoTake) {
  const TakeFolder folder;
  for (const std::string text : {"", "x", "not a take at all, but a text", "\x89MCAP0\r"}) {
    write_file(folder / "text", {text.begin(), text.end()});
    EXPECT_THROW(recover(folder / "text"), FileError);
    EXPECT_EQ(contents_of(folder / "text").size(), text.size());
  }
  EXPECT_THROW(recover(folder / "absent"), FileError);
}

}  // namespace
}  // namespace cordis::mcap
