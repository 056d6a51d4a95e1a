// tests/gallery/regrouping_test.cpp
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kCohesion = 0;
constexpr double kNear = 0.015;  // half as far again as two balls are at rest

TEST(Regrouping, ComesApartInTwoHalvesAndIsOneAgain) {
  GallerySession session("regrouping.yaml");
  engine::ConnectedComponents pieces(session.world().network(), kCohesion);
  const auto count = [&] { return pieces.find_near(session.world().positions(), kNear); };
  EXPECT_EQ(count(), 1u);

  session.play_until(2.9);  // the hands are apart
  EXPECT_EQ(count(), 2u);
  std::size_t first = 0;
  for (std::size_t i = 0; i < pieces.members().size(); ++i)
    first += pieces.component_of(i) == 0 ? 1 : 0;
  EXPECT_GE(std::min(first, pieces.members().size() - first), 20u);  // of 50

  session.play_until(6.0);  // and pressed together
  EXPECT_EQ(count(), 1u);
}

TEST(Regrouping, KeepsItsBallsOutOfEachOther) {
  GallerySession session("regrouping.yaml");
  const std::uint32_t count = session.mats("lump").count;
  double nearest = 1.0;
  int tick = 0;
  session.play_until(6.0, [&] {
    if (++tick % 20 != 0) return;
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = 0; b < a; ++b)
        nearest =
            std::min(nearest, (session.position("lump", a) - session.position("lump", b)).norm());
    }
  });
  EXPECT_GT(nearest, 0.85 * 0.01);  // of a diameter, when a hand drags them
}

}  // namespace
}  // namespace cordis::test
