// tests/viz/own_names_test.cpp
#include "viz_node/web/own_names.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>
#include <unistd.h>

namespace cordis::viz {
namespace {

TEST(OwnNames, AreTheHostNameItsFirstPartAndThatOfMdns) {
  const std::vector<std::string> names{"lab.example.org", "lab", "lab.local"};
  EXPECT_EQ(names_of_host("lab.example.org"), names);
  EXPECT_TRUE(names_of_host("").empty());
}

TEST(OwnNames, HoldWhatTheKernelSays) {
  std::array<char, 256> name{};
  ASSERT_EQ(gethostname(name.data(), name.size() - 1), 0);
  const std::vector<std::string> names = own_names();
  EXPECT_NE(std::ranges::find(names, std::string(name.data())), names.end());
}

}  // namespace
}  // namespace cordis::viz
