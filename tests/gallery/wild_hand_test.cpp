// tests/gallery/wild_hand_test.cpp -- scenes in a hand that drags wildly: they stay certified,
// nothing diverges, and no device gives more force than its limit.
#include "tests/gallery/wild_hand.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "device_node/drivers/pointer_port.h"
#include "tests/gallery/gallery_session.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

struct HeldScene {
  const char* name;
  std::size_t axes;
  double lowest_m;  // of the travel
  double highest_m;
  double felt_n;  // a force that such a hand feels at least once
};

constexpr double kForceLimit = 15.0;  // of devices/slider.yaml [N]
constexpr int kSeconds = 20;

class WildHandOn : public testing::TestWithParam<HeldScene> {};

TEST_P(WildHandOn, NeitherLetsGoNorDivergesNorPassesTheForceLimit) {
  const HeldScene& held = GetParam();
  const std::uint32_t seed = test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  GallerySession session(std::string(held.name) + ".yaml",
                         {"hand.driver=pointer", "hand.pointer.only_while_held=false"});
  device::PointerPort* const port = session.pointer_port("hand");
  ASSERT_NE(port, nullptr);
  WildHand hand(seed, held.axes, held.lowest_m, held.highest_m);
  double max_force_n = 0.0;

  while (!session.has_reached(rounds(kSeconds))) {
    port->target.put(hand.next());
    ASSERT_TRUE(session.play_tick()) << session.simulation().failure();
    ASSERT_EQ(session.bound_text(), "") << session.time_s() << " s";
    device::PointerFeel feel;
    while (port->feel.take(feel)) {
      for (std::size_t a = 0; a < held.axes; ++a) {
        ASSERT_LE(std::abs(feel.force_n[a]), kForceLimit) << session.time_s() << " s";
        max_force_n = std::max(max_force_n, std::abs(feel.force_n[a]));
      }
    }
  }
  if (rounds(kSeconds) < kSeconds) return;
  EXPECT_GT(max_force_n, held.felt_n) << "it is felt";
}

INSTANTIATE_TEST_SUITE_P(Gallery, WildHandOn,
                         testing::Values(HeldScene{"gravel", 1, -0.08, 0.08, 2.0},
                                         HeldScene{"bodies_meeting", 1, 0.0, 0.16, 0.5},
                                         HeldScene{"block_on_an_incline", 1, -0.08, 0.08, 0.5},
                                         HeldScene{"stirred_box", 2, -0.1, 0.1, 0.1}),
                         [](const auto& held) { return std::string(held.param.name); });

}  // namespace
}  // namespace cordis::test
