// tests/device/script_test.cpp
#include "device_node/drivers/script.h"

#include <gtest/gtest.h>

#include "node/config/value.h"
#include "node/config/yaml_reader.h"

namespace cordis::device {
namespace {

AxisLayout two_keys() {
  AxisLayout layout;
  layout.count = 2;
  return layout;
}

std::unique_ptr<Driver> script_of(const std::string& text, const AxisLayout& layout,
                                  config::Problems& problems) {
  return make_script(config::load_text(text, "script.yaml", problems), layout, problems);
}

constexpr const char* kScript =
    R"(interpolation: linear
repeat_s: 0.5
positions:
  - {at_s: 0.1, m: [0, -0.01]}
  - {at_s: 0.2, m: [-0.02, -0.01]}
  - {at_s: 0.3, m: -0.03}
forces:
  - {at_s: 0, n: -2.5}
)";

TEST(Script, GivesEachPointInItsVerySample) {
  config::Problems problems;
  const auto script = script_of(kScript, two_keys(), problems);
  ASSERT_EQ(problems.text(), "");
  AxisValues sensed;
  script->start(Role::kMass);

  for (int n = 0; n < 5000; ++n) {
    ASSERT_TRUE(script->read(sensed));
    const int in_cycle = n % 500;
    const bool first = n < 500;
    if (in_cycle == 0) {
      ASSERT_EQ(sensed[0], first ? 0.0 : -0.03) << n;
    }
    if (in_cycle == 100) {
      ASSERT_EQ(sensed[0], 0.0) << n;
    }
    if (in_cycle == 100) {
      ASSERT_EQ(sensed[1], -0.01) << n;
    }
    if (in_cycle == 150) {
      ASSERT_NEAR(sensed[0], -0.01, 1e-12) << n;
    }
    if (in_cycle == 200) {
      ASSERT_EQ(sensed[0], -0.02) << n;
    }
    if (in_cycle == 250) {
      ASSERT_NEAR(sensed[1], -0.02, 1e-12) << n;
    }
    if (in_cycle == 300) {
      ASSERT_EQ(sensed[1], -0.03) << n;
    }
    if (in_cycle == 450) {
      ASSERT_EQ(sensed[1], -0.03) << n;
    }
    ASSERT_EQ(sensed[2], 0.0);
    ASSERT_TRUE(script->write({}));
  }
}

TEST(Script, IsNotMovedByWhatItIsAnswered) {
  config::Problems problems;
  const auto one = script_of(kScript, two_keys(), problems);
  const auto other = script_of(kScript, two_keys(), problems);
  AxisValues from_one;
  AxisValues from_other;
  AxisValues force{};

  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(one->read(from_one));
    ASSERT_TRUE(other->read(from_other));
    ASSERT_EQ(from_one, from_other);
    force.fill(n);
    ASSERT_TRUE(one->write(force));
    ASSERT_TRUE(other->write({}));
  }
}

TEST(Script, GivesForcesInRoleLiaison) {
  config::Problems problems;
  const auto script = script_of(kScript, two_keys(), problems);
  AxisValues sensed;

  script->start(Role::kLiaison);
  ASSERT_TRUE(script->read(sensed));

  EXPECT_EQ(sensed[0], -2.5);
  EXPECT_EQ(sensed[1], -2.5);
}

TEST(Script, BeginsAnewWhenStarted) {
  config::Problems problems;
  const auto script = script_of(kScript, two_keys(), problems);
  AxisValues sensed;
  for (int n = 0; n < 300; ++n) ASSERT_TRUE(script->write({}));
  ASSERT_TRUE(script->read(sensed));
  ASSERT_EQ(sensed[0], -0.03);

  script->start(Role::kMass);
  ASSERT_TRUE(script->read(sensed));

  EXPECT_EQ(sensed[0], 0.0);
}

TEST(Script, CanPlayOnlyTheRolesItHasPointsFor) {
  config::Problems problems;
  const auto positions = script_of("positions: [{at_s: 0, m: 0}]", two_keys(), problems);
  const auto forces = script_of("forces: [{at_s: 0, n: 0}]", two_keys(), problems);
  ASSERT_EQ(problems.text(), "");

  EXPECT_TRUE(positions->can_play(Role::kMass));
  EXPECT_FALSE(positions->can_play(Role::kLiaison));
  EXPECT_FALSE(forces->can_play(Role::kMass));
  EXPECT_TRUE(forces->can_play(Role::kLiaison));
}

struct BadScript {
  const char* text;
  const char* problem;
};

class ScriptProblem : public testing::TestWithParam<BadScript> {};

TEST_P(ScriptProblem, IsReportedWithItsPlace) {
  config::Problems problems;

  const auto script = script_of(GetParam().text, two_keys(), problems);

  EXPECT_EQ(script, nullptr);
  EXPECT_NE(problems.text().find(GetParam().problem), std::string::npos) << problems.text();
}

INSTANTIATE_TEST_SUITE_P(
    All, ScriptProblem,
    testing::Values(
        BadScript{"repeat_s: 1", "script.yaml:1:1: error: script needs positions or forces"},
        BadScript{"positions: [{at_s: 1, m: 0}, {at_s: 1, m: 0}]",
                  "script.yaml:1:37: error: at_s must be later than in the point before"},
        BadScript{"positions: [{at_s: 0, m: [0, 0, 0]}]",
                  "script.yaml:1:26: error: m must be one number, or 2, one per axis; got 3"},
        BadScript{"positions: [{at_s: 0, m: 0.001}]",
                  "script.yaml:1:26: error: m must be within -0.04 and 0, got 0.001"},
        BadScript{"forces: [{at_s: 0, n: -21}]",
                  "script.yaml:1:23: error: n must be within -20 and 20, got -21"},
        BadScript{"{repeat_s: 1, positions: [{at_s: 0, m: 0}, {at_s: 2, m: 0}]}",
                  "script.yaml:1:44: error: this point comes after repeat_s"},
        BadScript{"{interpolation: cubic, positions: [{at_s: 0, m: 0}]}",
                  "script.yaml:1:17: error: 'interpolation' in script must be one of"},
        BadScript{"positions: [{at_s: 0, n: 0}]", "unknown key 'n' in point"}));

}  // namespace
}  // namespace cordis::device
