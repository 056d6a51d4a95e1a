// tests/gallery/plasticine_test.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "device_node/drivers/pointer_port.h"
#include "sim_node/engine/connected_components.h"
#include "tests/gallery/gallery_session.h"
#include "tests/gallery/wild_hand.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

constexpr double kReach = 0.0075;  // of the law

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs neighbours(const GallerySession& session) {
  const scene::NamedRange paste = session.mats("paste");
  Pairs pairs;
  for (std::uint32_t a = 0; a < paste.count; ++a) {
    for (std::uint32_t b = a + 1; b < paste.count; ++b) {
      const double distance = (session.position("paste", b) - session.position("paste", a)).norm();
      if (distance < kReach) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

/// Counts the pairs that both lists have. Both ascend.
std::size_t in_common(const Pairs& some, const Pairs& others) {
  return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [&](const auto& pair) {
    return std::binary_search(others.begin(), others.end(), pair);
  }));
}

TEST(Plasticine, IsMouldedTornAndStuckTogetherAgain) {
  GallerySession session("plasticine.yaml");
  std::vector<double> history;
  const auto note = [&] {
    const double pieces = session.signal("pieces");
    if (history.empty() || history.back() != pieces) history.push_back(pieces);
  };
  session.play_until(0.3, note);
  const Pairs before = neighbours(session);

  session.play_until(2.0, note);  // the fingers are apart
  engine::ConnectedComponents pieces(session.world().network(), 0);
  ASSERT_EQ(pieces.find_near(session.world().positions(), kReach), 2u);
  std::size_t first = 0;
  for (std::size_t i = 0; i < 400; ++i) first += pieces.component_of(i) == 0 ? 1 : 0;
  EXPECT_GE(std::min(first, 400 - first), 90u);
  EXPECT_LT(in_common(before, neighbours(session)),
            before.size() * 4 / 5);  // what is elastic keeps all

  session.play_until(2.9, note);  // and together
  EXPECT_EQ(history, (std::vector<double>{1, 2, 1}));
}

TEST(Plasticine, StaysCertifiedWhateverAHandOnThePageDoes) {
  const std::uint32_t seed = test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  GallerySession session("plasticine.yaml",
                         {"thimbles.driver=pointer", "thimbles.pointer.only_while_held=false"});
  device::PointerPort* const port = session.pointer_port("thimbles");
  ASSERT_NE(port, nullptr);
  WildHand hand(seed, 4, -0.08, 0.08);
  constexpr int kSeconds = 20;
  double max_pieces = 0.0;
  double max_force_n = 0.0;

  while (!session.has_reached(rounds(kSeconds))) {
    port->target.put(hand.next());
    ASSERT_TRUE(session.play_tick());
    ASSERT_EQ(session.bound_text(), "") << session.time_s() << " s";
    max_pieces = std::max(max_pieces, session.signal("pieces"));
    max_force_n = std::max(max_force_n, std::abs(session.signal("left_force")));
  }
  if (rounds(kSeconds) < kSeconds) return;
  EXPECT_GE(max_pieces, 2.0) << "it is torn";
  EXPECT_GT(max_force_n, 2.0) << "and pressed";
}

}  // namespace
}  // namespace cordis::test
