// tests/record/count_take.h -- a small take without a node of Cordis, and who listens to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/topic_listener.h"
#include "record_node/mcap/writer.h"
#include "tests/mcap/take_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::test {

inline constexpr std::uint32_t kCounted = 40;            // messages
inline constexpr std::uint64_t kCountNsec = 20'000'000;  // between two of them
inline const std::string kCountIdl = "module lab { struct Count { unsigned long number; }; };\n";

/// Writes the numbers from 0 on to a topic, reliable, of a session named `count`. Each chunk holds few
/// messages.
inline void write_count_take(const std::filesystem::path& path, bool is_exclusive = false,
                             const std::string& topic = "lab/count") {
  mcap::WriterConfig config;
  config.chunk_bytes = 200;
  mcap::Writer writer(path, config);
  const std::uint16_t schema = writer.add_schema({0, "lab::Count", "omgidl", kCountIdl});
  const std::uint16_t channel = writer.add_channel({.schema_id = schema,
                                                    .topic = topic,
                                                    .message_encoding = "cdr",
                                                    .metadata = {{"qos", R"(reliability: true
durability: false
ownership: )" + std::string(is_exclusive ? "true" : "false") + "\n"}}});
  ASSERT_EQ(writer.add_metadata({"cordis.session", {{"session", "count"}}}),
            mcap::WriteStatus::kOk);
  for (std::uint32_t number = 0; number < kCounted; ++number) {
    const std::uint64_t time = 1'700'000'000'000'000'000 + number * kCountNsec;
    std::vector<std::byte> payload(8);
    payload[1] = std::byte{1};  // little-endian
    std::memcpy(&payload[4], &number, sizeof number);
    ASSERT_EQ(writer.write({channel, number, time, time, payload}), mcap::WriteStatus::kOk);
  }
  ASSERT_EQ(writer.close(), mcap::WriteStatus::kOk);
}

/// Receives the numbers that are played in a session.
class CountListener {
 public:
  explicit CountListener(const std::string& session, const std::string& topic = "lab/count")
      : listener_(cli::SessionAddress{session, own_domain(), {}, {}}, topic, /*with_bytes=*/true) {}

  /// All that have come so far.
  const std::vector<std::uint32_t>& received() {
    for (const cli::ReceivedMessage& message : listener_.take(std::chrono::milliseconds(0))) {
      EXPECT_EQ(message.bytes.size(), 8u);
      if (message.bytes.size() == 8) std::memcpy(&received_.emplace_back(), &message.bytes[4], 4);
    }
    return received_;
  }
  bool receives(const std::vector<std::uint32_t>& numbers) {
    return eventually([&] { return received() == numbers; });
  }

 private:
  cli::TopicListener listener_;
  std::vector<std::uint32_t> received_;
};

/// The numbers of a range, its end left out.
inline std::vector<std::uint32_t> numbers(std::uint32_t from, std::uint32_t end) {
  std::vector<std::uint32_t> range;
  for (std::uint32_t number = from; number < end; ++number) range.push_back(number);
  return range;
}

}  // namespace cordis::test
