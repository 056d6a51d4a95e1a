// tests/record/record_config_test.cpp -- the section of a recorder in a launch file.
#include "record_node/record_config.h"

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"

namespace cordis::record {
namespace {

std::string complaint(const std::string& section) {
  config::Problems problems;
  config::LaunchNode node;
  node.name = "record";
  node.section = config::load_word(section, "launch.yaml", problems);
  static_cast<void>(read_record_section(node, problems));
  return problems.text();
}

TEST(RecordSection, ReportsAWordInBracesThatNothingFillsIn) {
  EXPECT_NE(complaint("{out: 'takes/{tme}.mcap'}")
                .find("the name of a take has {session} and {time} alone, not '{tme}'"),
            std::string::npos)
      << complaint("{out: 'takes/{tme}.mcap'}");
  EXPECT_NE(complaint("{out: 'takes/{time'}").find("not '{time'"), std::string::npos);
  EXPECT_EQ(complaint("{out: 'takes/{session}-{time}.mcap'}"), "");
  EXPECT_EQ(complaint("{}"), "");
}

}  // namespace
}  // namespace cordis::record
