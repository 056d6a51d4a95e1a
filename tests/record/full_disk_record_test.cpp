// tests/record/full_disk_record_test.cpp -- `cordis record` where there is no more room.
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "record_node/mcap/reader.h"
#include "tests/record/count_take.h"
#include "tests/support/child_process.h"

namespace cordis {
namespace {

using test::ChildProcess;
using test::kPatience;

const std::string kWhole = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

TEST(FullDisk, EndsARecordingWholeAndCountsEachMessage) {
  const mcap::TakeFolder folder;
  const std::string domain = std::to_string(test::own_domain());
  const std::string played = folder / "played.mcap";
  const std::string take = folder / "take.mcap";
  test::write_count_take(played);
  ChildProcess player(
      {kWhole, "play", played, "--loop", "--rate", "40", "--session", "full", "--domain", domain});
  ASSERT_TRUE(player.wait_for_output("session 'full'", kPatience));
  // A file may have 300 kB here; 64 kB of them are kept for its end.
  ChildProcess recorder({"/bin/bash", "-c",
                         "trap '' XFSZ; ulimit -f 300; exec " + kWhole + " record full --domain " +
                             domain + " --compression none -o " + take});
  EXPECT_EQ(recorder.wait(kPatience), 3) << recorder.output();
  EXPECT_NE(recorder.output().find("no room for more of " + take), std::string::npos)
      << recorder.output();
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(kPatience), 0) << player.output();

  const mcap::Reader reader(take);
  EXPECT_TRUE(reader.is_whole()) << reader.damage();
  const std::uint64_t stored = reader.statistics().message_count;
  EXPECT_GT(stored, 0u);
  EXPECT_NE(recorder.output().find(take + ": " + std::to_string(stored) + " messages"),
            std::string::npos)
      << recorder.output();
  for (const mcap::Metadata& words : reader.metadata()) {
    if (words.name != "cordis.recording") continue;
    const auto number = [&](const char* key) { return std::stoull(words.values.at(key)); };
    EXPECT_GT(number("messages_dropped"), 0u);
    EXPECT_EQ(number("messages_received"), stored + number("messages_dropped"));
    return;
  }
  FAIL() << "the take does not say what was dropped";
}

}  // namespace
}  // namespace cordis
