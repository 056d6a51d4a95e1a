// tests/mcap/random_take.h -- a take of random channels and messages, known outside the file.
#pragma once

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"

namespace cordis::mcap {

/// A message that owns its data.
struct OwnedMessage {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_nsec = 0;
  std::uint64_t publish_time_nsec = 0;
  std::vector<std::byte> data;
  bool operator==(const OwnedMessage&) const = default;

  Message message() const { return {channel_id, sequence, log_time_nsec, publish_time_nsec, data}; }
  static OwnedMessage of(const Message& message) {
    return {message.channel_id,
            message.sequence,
            message.log_time_nsec,
            message.publish_time_nsec,
            {message.data.begin(), message.data.end()}};
  }
};

inline std::vector<std::byte> random_bytes(std::mt19937& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  const unsigned spread = 1 + random() % 256;  // few values pack well
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() % spread);
  return bytes;
}

/// What a random take holds, in the order in which it was written.
struct RandomTake {
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  std::vector<OwnedMessage> messages;
  std::vector<Metadata> metadata;
  std::vector<std::byte> attachment;

  /// By log time; messages of the same time keep their order.
  std::vector<OwnedMessage> by_time() const {
    std::vector<OwnedMessage> sorted = messages;
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return a.log_time_nsec < b.log_time_nsec;
    });
    return sorted;
  }
};

/// Writes a take of `count` messages, the later ones up to `disorder_nsec` before earlier ones.
inline RandomTake write_random_take(const std::filesystem::path& path, std::mt19937& random,
                                    const WriterConfig& config, std::size_t count,
                                    std::uint64_t disorder_nsec = 0) {
  RandomTake take;
  Writer writer(path, config);
  const std::size_t schema_count = 1 + random() % 3;
  for (std::size_t i = 0; i < schema_count; ++i) {
    Schema schema{0, "cordis::msg::Type" + std::to_string(i), "omgidl", "struct Type;"};
    schema.id = writer.add_schema(schema);
    EXPECT_NE(schema.id, 0);
    take.schemas.push_back(schema);
  }
  const std::size_t channel_count = 1 + random() % 5;
  for (std::size_t i = 0; i < channel_count; ++i) {
    Channel channel{0,
                    static_cast<std::uint16_t>(random() % (schema_count + 1)),
                    "topic/" + std::to_string(i),
                    "cdr",
                    {{"qos", "reliability: true"}}};
    channel.id = writer.add_channel(channel);
    EXPECT_NE(channel.id, 0);
    take.channels.push_back(channel);
  }
  take.metadata.push_back({"cordis.session", {{"seed", std::to_string(random())}, {"", "ü"}}});
  EXPECT_EQ(writer.add_metadata(take.metadata.back()), WriteStatus::kOk);
  take.attachment = random_bytes(random, random() % 5000);
  EXPECT_EQ(writer.attach({"scene.yaml", "application/yaml", 5, 7, take.attachment}),
            WriteStatus::kOk);
  std::uint64_t now = 1'700'000'000'000'000'000;
  for (std::size_t i = 0; i < count; ++i) {
    now += random() % 2'000'000;
    OwnedMessage message;
    message.channel_id = take.channels[random() % channel_count].id;
    message.sequence = static_cast<std::uint32_t>(i + 1);
    message.log_time_nsec = now - (disorder_nsec == 0 ? 0 : random() % disorder_nsec);
    message.publish_time_nsec = message.log_time_nsec - random() % 1000;
    message.data = random_bytes(random, random() % 400);
    EXPECT_EQ(writer.write(message.message()), WriteStatus::kOk);
    EXPECT_EQ(writer.close_chunk_if_older(now), WriteStatus::kOk);
    take.messages.push_back(std::move(message));
  }
  EXPECT_EQ(writer.close(), WriteStatus::kOk) << writer.problem();
  return take;
}

inline std::vector<OwnedMessage> messages_of(const Reader& reader,
                                             const MessageFilter& filter = {}) {
  std::vector<OwnedMessage> messages;
  MessageCursor cursor = reader.messages(filter);
  for (Message message; cursor.next(message);) messages.push_back(OwnedMessage::of(message));
  return messages;
}

}  // namespace cordis::mcap
