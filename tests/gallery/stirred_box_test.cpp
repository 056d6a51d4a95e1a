// tests/gallery/stirred_box_test.cpp
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kTouch = 0.0063;  // two balls that touch, and a little

std::vector<std::uint32_t> crowd(const GallerySession& session) {
  std::vector<std::uint32_t> balls;
  for (const char* name : {"middle", "below", "above"}) {
    const scene::NamedRange range = session.mats(name);
    for (std::uint32_t i = 0; i < range.count; ++i) balls.push_back(range.first + i);
  }
  return balls;
}

/// The flow along a circle about the middle of the box, from the balls near it [m^2/s].
double circulation(const GallerySession& session, double radius) {
  double sum = 0.0;
  double count = 0.0;
  for (const std::uint32_t ball : crowd(session)) {
    const engine::Vec3 place = session.world().position(ball);
    if (std::abs(place.norm() - radius) > 0.01) continue;
    const engine::Vec3 velocity = session.world().velocity(ball);
    sum += (place.x() * velocity.y() - place.y() * velocity.x()) / place.norm();
    count += 1.0;
  }
  return 2.0 * std::numbers::pi * radius * sum / count;
}

/// The balls that six others touch: in the midst of a crystal.
std::vector<std::uint32_t> ordered(const GallerySession& session) {
  const std::vector<std::uint32_t> balls = crowd(session);
  std::vector<std::uint32_t> found;
  for (const std::uint32_t a : balls) {
    int touching = 0;
    for (const std::uint32_t b : balls) {
      const double distance = (session.world().position(b) - session.world().position(a)).norm();
      touching += a != b && distance < kTouch ? 1 : 0;
    }
    if (touching == 6) found.push_back(a);
  }
  return found;
}

/// Number of balls of each cluster, the largest first.
std::vector<std::size_t> cluster_sizes(const GallerySession& session) {
  const std::vector<std::uint32_t> balls = ordered(session);
  if (balls.empty()) return {};
  engine::ConnectedComponents pieces(session.world().network().description(), balls);
  std::vector<std::size_t> sizes(pieces.find_near(session.world().positions(), kTouch));
  for (std::size_t i = 0; i < balls.size(); ++i) ++sizes[pieces.component_of(i)];
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

TEST(StirredBox, TurnsWithTheSpoonAndOrdersItselfInClusters) {
  GallerySession session("stirred_box.yaml");
  const auto count = static_cast<double>(crowd(session).size());
  EXPECT_LT(static_cast<double>(ordered(session).size()), 0.02 * count);  // thrown at random
  session.play_until(1.0);

  double inner = 0.0;
  double outer = 0.0;
  session.play_until(2.0, [&] {  // one turn
    inner += circulation(session, 0.045) / 1000.0;
    outer += circulation(session, 0.07) / 1000.0;
  });
  const std::vector<std::size_t> sizes = cluster_sizes(session);
  RecordProperty("circulation, inner", std::to_string(inner));
  RecordProperty("circulation, outer", std::to_string(outer));
  RecordProperty("ordered", std::to_string(static_cast<double>(ordered(session).size()) / count));
  for (const std::size_t i : {0, 1, 2}) {
    RecordProperty("crystal " + std::to_string(i), std::to_string(sizes.at(i)));
  }
  EXPECT_GT(inner, 0.01);   // the spoon goes at 0.28 m/s: 0.08 m^2/s if all balls went with it
  EXPECT_GT(outer, 0.003);  // at the walls it is less
  EXPECT_LT(outer, inner);
  EXPECT_GT(static_cast<double>(ordered(session).size()), 0.25 * count);
  ASSERT_GE(sizes.size(), 3u);
  EXPECT_GE(sizes[0], 50u);
  EXPECT_GE(sizes[2], 10u);
}

}  // namespace
}  // namespace cordis::test
