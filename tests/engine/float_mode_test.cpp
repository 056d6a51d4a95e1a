// tests/engine/float_mode_test.cpp -- a world computes the same bits in every floating-point mode
// of its caller, and what has faded away costs nothing.
#include "sim_node/engine/core/float_mode.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

constexpr unsigned kDefaultMode = 0x1f80;
constexpr unsigned kFlushesAndRoundsUp = 0xdfc0;

/// The mode of the caller, for a while.
class CallerMode {
 public:
  explicit CallerMode(unsigned mode) : before_(_mm_getcsr()) { _mm_setcsr(mode); }
  ~CallerMode() { _mm_setcsr(before_); }
  CallerMode(const CallerMode&) = delete;
  CallerMode& operator=(const CallerMode&) = delete;

 private:
  unsigned before_;
};

/// A string that is struck and comes to rest at 0: after 60,000 steps its amplitude would be below
/// 1e-308 m.
NetworkDescription fading_string(engine::IntegratorKind integrator) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-4;
  scene.integrator = integrator;
  scene.medium_viscosity = 0.3;
  constexpr std::uint32_t kCount = 20;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const bool is_end = i == 0 || i + 1 == kCount;
    scene.mats.push_back(is_end ? fixed(Vec3::Zero()) : mass(0.001, Vec3::Zero()));
    if (i > 0) scene.links.push_back({i - 1, i, 1000.0, 0.02, 0.0});
  }
  scene.mats[7].velocity = Vec3(1.0, 0.0, 0.0);
  return scene;
}

class FadingString : public testing::TestWithParam<engine::IntegratorKind> {};

TEST_P(FadingString, NeverHoldsASubnormalNumber) {
  World world = make_world(fading_string(GetParam()));
  double largest = 1.0;
  for (int i = 0; i < 600; ++i) {
    run(world, 100);
    const engine::Columns& positions = world.positions();
    largest = 0.0;
    for (std::uint32_t mat = 0; mat < world.network().mat_count(); ++mat) {
      const double speed = world.velocity(mat).x();
      for (const double value : {positions(0, mat), speed})
        ASSERT_NE(std::fpclassify(value), FP_SUBNORMAL) << value << " at step " << 100 * i;
      largest = std::max(largest, std::abs(positions(0, mat)));
    }
  }
  EXPECT_LT(largest, 1e-300) << "it has faded away";
}

TEST_P(FadingString, HasTheSameBitsInEveryModeOfItsCaller) {
  const auto hashes_in = [](unsigned mode) {
    const CallerMode caller(mode);
    std::vector<std::uint64_t> hashes;
    World world = make_world(fading_string(GetParam()));
    for (int i = 0; i < 120; ++i) {
      run(world, 500);
      hashes.push_back(world.state_hash());
      hashes.push_back(std::bit_cast<std::uint64_t>(world.energy().kinetic));
      hashes.push_back(std::bit_cast<std::uint64_t>(world.momentum().x()));
    }
    const engine::Snapshot snapshot = world.snapshot();
    world.restore(snapshot);
    run(world, 1);
    hashes.push_back(world.state_hash());
    EXPECT_EQ(_mm_getcsr() & ~0x3fu, mode) << "the caller's mode is given back";
    return hashes;
  };

  EXPECT_EQ(hashes_in(kFlushesAndRoundsUp), hashes_in(kDefaultMode));
}

INSTANTIATE_TEST_SUITE_P(Integrators, FadingString,
                         testing::Values(engine::IntegratorKind::kCordis,
                                         engine::IntegratorKind::kLeapfrog,
                                         engine::IntegratorKind::kImplicit,
                                         engine::IntegratorKind::kModal),
                         [](const auto& instance) { return to_string(instance.param); });

}  // namespace
}  // namespace cordis::test
