// tests/gallery/sand_heap_test.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// The highest ball of the sand within a distance from a point of the floor [m].
double height_near(const GallerySession& session, double x, double z) {
  constexpr double kBeside = 0.012;
  const scene::NamedRange sand = session.mats("sand");
  double highest = 0.0;
  for (std::uint32_t i = sand.first; i < sand.first + sand.count; ++i) {
    const engine::Vec3& place = session.world().position(i);
    if (std::hypot(place.x() - x, place.z() - z) < kBeside) highest = std::max(highest, place.y());
  }
  return highest;
}

TEST(SandHeap, StandsUntilAHandPloughsThroughIt) {
  GallerySession session("sand_heap.yaml");
  const double weight = session.mats("sand").count * 0.001 * 9.81;
  session.play_until(2.4);
  const double top = height_near(session, 0.0, 0.0);
  EXPECT_GT(top, 0.03);  // without friction it runs apart to a layer of one ball
  EXPECT_NEAR(session.signal("floor_force"), -weight, 0.02 * weight);
  EXPECT_LT(session.signal("kinetic_energy"), 1e-6);

  double pushed = 0.0;
  session.play_until(6.0,
                     [&] { pushed = std::max(pushed, std::abs(session.signal("hand_force_x"))); });
  EXPECT_GT(pushed, 0.3);
  EXPECT_LT(height_near(session, 0.0, 0.0), top - 0.01);  // the furrow stays
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
