// tests/device/allocation_test.cpp -- a program of its own: it replaces operator new.
#include <gtest/gtest.h>

#include "device_node/drivers/mock.h"
#include "device_node/drivers/script.h"
#include "device_node/force_guard.h"
#include "device_node/position_guard.h"
#include "tests/support/allocation_guard.h"

namespace cordis::device {
namespace {

constexpr int kPeriods = 1000;

Trajectory pressing(double target) {
  return {0.0, {{0.1, 0.3, target}}, Trajectory::Shape::kMinimumJerk, 0.7};
}

/// Allocations of a driver that lives for a while under commands that change.
std::size_t allocations_of(Driver& driver, Role role) {
  driver.start(role);
  AxisValues values{};

  const test::AllocationGuard guard;
  for (int n = 0; n < kPeriods; ++n) {
    static_cast<void>(driver.write(values));
    static_cast<void>(driver.read(values));
    for (double& value : values) value *= 0.5;
  }
  return guard.count();
}

TEST(Mock, LivesWithoutAllocating) {
  AxisLayout layout;
  layout.count = kMaxAxes;
  MockSettings settings;
  settings.gesture = {pressing(-0.03)};
  for (int a = 0; a < kMaxAxes; ++a) settings.played.push_back(a);
  Mock mock(settings, layout);

  EXPECT_EQ(allocations_of(mock, Role::kMass), 0u);
  EXPECT_EQ(allocations_of(mock, Role::kLiaison), 0u);
}

TEST(Script, LivesWithoutAllocating) {
  Script script({pressing(-0.03), pressing(-0.02)}, {pressing(-2.0), pressing(3.0)}, 1000.0);

  EXPECT_EQ(allocations_of(script, Role::kMass), 0u);
  EXPECT_EQ(allocations_of(script, Role::kLiaison), 0u);
}

TEST(Guards, TickWithoutAllocating) {
  ForceGuard force_guard{ForceGuardSettings{}};
  PositionGuard position_guard{PositionGuardSettings{}};
  AxisValues wanted{};

  const test::AllocationGuard guard;
  for (int n = 0; n < kPeriods; ++n) {
    wanted.fill(n % 7 - 3.0);
    force_guard.accept(wanted);
    position_guard.accept(wanted);
    force_guard.tick(n % 40 * 0.001, {});
    position_guard.tick(n % 40 * 0.001);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::device
