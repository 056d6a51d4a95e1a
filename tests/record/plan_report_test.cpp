// tests/record/plan_report_test.cpp -- the output of a process beside a recording.
#include "record_node/plan_report.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <gtest/gtest.h>

#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"
#include "record_node/recorder.h"
#include "tests/mcap/take_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::record {
namespace {

using namespace std::chrono_literals;

PlanReport shell(const std::string& words) {
  return PlanReport({"/bin/sh", "-c", words});
}

TEST(PlanReport, IsWhatTheProcessSaysOnBothStreamsOnce) {
  PlanReport report = shell("echo stable; echo careful >&2; exit 0");
  EXPECT_EQ(report.take(test::kPatience), "stable\ncareful\n");
  EXPECT_FALSE(report.is_under_way());
  EXPECT_EQ(report.take(test::kPatience), std::nullopt);
}

TEST(PlanReport, IsThereWhenTheCheckRefusesAndNotWhenItFails) {
  EXPECT_EQ(shell("echo unstable; exit 2").take(test::kPatience), "unstable\n");
  EXPECT_EQ(shell("echo broken; exit 1").take(test::kPatience), std::nullopt);
  EXPECT_EQ(shell("kill -9 $$").take(test::kPatience), std::nullopt);
}

TEST(PlanReport, IsNoneWithoutAProcess) {
  PlanReport none({});
  EXPECT_FALSE(none.is_under_way());
  EXPECT_EQ(none.take(0ms), std::nullopt);
  PlanReport absent({"/no/such/program"});
  EXPECT_FALSE(absent.is_under_way());
  EXPECT_EQ(absent.take(0ms), std::nullopt);
}

TEST(PlanReport, EndsItsProcess) {
  const mcap::TakeFolder folder;
  const std::string file = folder / "process";
  {
    PlanReport report = shell("echo $$ > " + file + "; exec sleep 600");
    std::string number;
    ASSERT_TRUE(test::eventually([&] {
      std::ifstream(file) >> number;
      return !number.empty();
    }));
    EXPECT_EQ(report.take(0ms), std::nullopt);
    EXPECT_TRUE(report.is_under_way());
    EXPECT_TRUE(std::filesystem::exists("/proc/" + number));
  }
  std::string number;
  std::ifstream(file) >> number;
  EXPECT_FALSE(std::filesystem::exists("/proc/" + number));
}

TEST(PlanReport, IsAttachedToATakeThatIsRecordedBesideIt) {
  const mcap::TakeFolder folder;
  RecorderConfig config;
  config.domain = test::own_domain();
  config.session = "plan";
  config.out = folder / "take.mcap";
  config.plan_command = {"/bin/sh", "-c", "sleep 0.1; echo stable"};
  Recorder recorder(config);
  ASSERT_TRUE(test::eventually([&] {
    const std::filesystem::path part = mcap::part_of(config.out);
    std::error_code absent;
    return std::filesystem::file_size(part, absent) > 100 && !absent &&
           !mcap::Reader(part).attachments().empty();
  }));
  recorder.close();
  const mcap::Reader take(config.out);
  EXPECT_TRUE(take.is_whole()) << take.damage();
  ASSERT_EQ(take.attachments().size(), 1u);
  const mcap::Attachment file = take.attachments().front();
  EXPECT_EQ(file.name, "plan.txt");
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(file.data.data()), file.data.size()),
            "stable\n");
}

}  // namespace
}  // namespace cordis::record
