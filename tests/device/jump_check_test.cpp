// tests/device/jump_check_test.cpp
#include "device_node/drivers/jump_check.h"

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

TEST(JumpCheck, BelievesWhatAHandCanDo) {
  JumpCheck check(1000.0);
  EXPECT_TRUE(check.believes({0.03})) << "the first place, wherever it is";
  EXPECT_TRUE(check.believes({0.0399})) << "9.9 m/s";
  EXPECT_FALSE(check.believes({0.0501})) << "10.2 m/s";
  JumpCheck slower(500.0);
  EXPECT_TRUE(slower.believes({0.0, 0.03}));
  EXPECT_TRUE(slower.believes({0.0, 0.0499})) << "9.9 m/s in two milliseconds";
}

TEST(JumpCheck, LeavesOutOneDamagedPlace) {
  JumpCheck check(1000.0);
  EXPECT_TRUE(check.believes({0.0, 0.01}));
  EXPECT_FALSE(check.believes({0.0, 0.06}));
  EXPECT_TRUE(check.believes({0.0, 0.011}));
  EXPECT_FALSE(check.believes({0.0, 0.06})) << "that it was said before is long ago";
}

TEST(JumpCheck, BelievesASecondPlaceThatSaysTheSame) {
  JumpCheck check(1000.0);
  EXPECT_TRUE(check.believes({0.0}));
  EXPECT_FALSE(check.believes({0.06}));
  EXPECT_TRUE(check.believes({0.062}));
  EXPECT_TRUE(check.believes({0.06}));
  EXPECT_FALSE(check.believes({0.0}));
  EXPECT_FALSE(check.believes({0.03})) << "neither here nor there";
}

TEST(JumpCheck, BeginsAnew) {
  JumpCheck check(1000.0);
  EXPECT_TRUE(check.believes({0.0}));
  check.forget();
  EXPECT_TRUE(check.believes({0.06}));
}

}  // namespace
}  // namespace cordis::device
