// tests/record/foreign_test.cpp -- programs of CycloneDDS are recorded, and read what is played.
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record_node/mcap/reader.h"
#include "tests/record/count_take.h"
#include "tests/support/child_process.h"

namespace cordis {
namespace {

using test::ChildProcess;
using test::kPatience;

const std::string kRecorder = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

class Foreign : public ::testing::Test {
 protected:
  std::vector<std::string> cyclone(const std::vector<std::string>& words) const {
    std::vector<std::string> all{CORDIS_CYCLONE_LAB, domain_};
    all.insert(all.end(), words.begin(), words.end());
    return all;
  }

  /// Records the domain until the take holds something, and gives the name of the file.
  std::string record(const std::string& name, const std::vector<std::string>& more) const {
    const std::string take = folder_ / name;
    std::vector<std::string> words{kRecorder, "record", "--domain", domain_, "-o", take};
    words.insert(words.end(), more.begin(), more.end());
    ChildProcess recorder(words);
    EXPECT_TRUE(test::eventually([&] {
      std::error_code none;
      const auto size = std::filesystem::file_size(take + ".part", none);
      return !none && size > 8000;
    })) << recorder.output();
    recorder.signal(SIGINT);
    EXPECT_EQ(recorder.wait(kPatience), 0) << recorder.output();
    return take;
  }

  /// The numbers of a take, which follow each other.
  static void expect_counts(const mcap::Reader& take) {
    mcap::MessageCursor cursor = take.messages({.topics = {"lab/count"}});
    std::optional<std::uint32_t> last;
    std::size_t count = 0;
    for (mcap::Message message; cursor.next(message); ++count) {
      ASSERT_EQ(message.data.size(), 8u);
      std::uint32_t number = 0;
      std::memcpy(&number, &message.data[4], sizeof number);
      if (last) {
        ASSERT_EQ(number, *last + 1);
      }
      last = number;
      EXPECT_EQ(message.data[1], std::byte{1});  // little-endian, as CycloneDDS wrote it
    }
    EXPECT_GT(count, 20u);
  }

  mcap::TakeFolder folder_;
  const std::string domain_ = std::to_string(test::own_domain());
  const std::map<std::string, std::string> place_{
      {"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}};
};

TEST_F(Foreign, ProgramIsRecordedWithItsSchemaAndWithout) {
  const ChildProcess writer(cyclone({"write"}), place_);
  const mcap::Reader without(record("without.mcap", {}));
  const mcap::Reader with(
      record("with.mcap", {"--idl", CORDIS_SOURCE_DIR "/tests/record/count.idl"}));
  for (const mcap::Reader* take : {&without, &with}) {
    EXPECT_TRUE(take->is_whole()) << take->damage();
    expect_counts(*take);
    for (const auto& [id, channel] : take->channels()) {
      if (channel.topic != "lab/count") continue;
      EXPECT_EQ(channel.message_encoding, "cdr");
      EXPECT_EQ(channel.metadata.at("type"), "lab::Count");
      const mcap::Schema* schema = take->schema_of(channel);
      ASSERT_EQ(schema != nullptr, take == &with);
      if (schema == nullptr) continue;
      EXPECT_EQ(schema->name, "lab::Count");
      EXPECT_EQ(schema->encoding, "omgidl");
    }
  }
}

TEST_F(Foreign, ProgramReadsWhatIsPlayed) {
  const std::string take = folder_ / "take.mcap";
  test::write_count_take(take);
  ChildProcess reader(cyclone({"read", "count"}), place_);
  ChildProcess player({kRecorder, "play", take, "--domain", domain_, "--wait-for-readers",
                       "--start-paused", "--rate", "5"});
  ASSERT_TRUE(reader.wait_for_output("matched\n", kPatience)) << player.output();
  ChildProcess resume({kRecorder, "ctl", "count", "--domain", domain_, "resume"});
  EXPECT_EQ(resume.wait(kPatience), 0) << resume.output();
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();
  EXPECT_TRUE(reader.wait_for_output("number 39\n", kPatience)) << reader.output();
  std::string all = "matched\n";
  for (std::uint32_t number = 0; number < test::kCounted; ++number)
    all += "number " + std::to_string(number) + "\n";
  EXPECT_EQ(reader.output(), all);
}

}  // namespace
}  // namespace cordis
