// tests/node/last_take_test.cpp
#include "node/last_take.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

class LastTake : public ::testing::Test {
 protected:
  LastTake() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~LastTake() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name) const {
    std::ofstream(folder_ / name) << "x";
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(LastTake, IsTheNewestOfEachSession) {
  EXPECT_FALSE(last_take(folder_, "piano").has_value());
  const fs::path first = file("first.mcap");
  const fs::path second = file("with a blank.mcap");
  remember_take(folder_, "piano", first);
  remember_take(folder_, "drum", first);
  remember_take(folder_, "piano", second);
  EXPECT_EQ(last_take(folder_, "piano"), second);
  EXPECT_EQ(last_take(folder_, "drum"), first);
}

TEST_F(LastTake, IsTheUnfinishedFileOfARecorderThatDied) {
  remember_take(folder_, "piano", folder_ / "take.mcap");
  EXPECT_FALSE(last_take(folder_, "piano").has_value()) << "no file has that name";
  const fs::path part = file("take.mcap.part");
  EXPECT_EQ(last_take(folder_, "piano"), part);
  const fs::path whole = file("take.mcap");
  EXPECT_EQ(last_take(folder_, "piano"), whole);
  fs::remove(part);
  fs::remove(whole);
  EXPECT_FALSE(last_take(folder_, "piano").has_value()) << "it was moved away";
}

TEST_F(LastTake, IsNotKeptWhereNoFileCanBeMade) {
  remember_take(folder_ / "nowhere", "piano", folder_ / "take.mcap");
  EXPECT_FALSE(last_take(folder_ / "nowhere", "piano").has_value());
}

}  // namespace
}  // namespace cordis::node
