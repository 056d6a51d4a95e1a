// tests/gallery/bowed_string_test.cpp
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// Lowest frequency [Hz] of 40 masses between fixed ends, joined by 41 springs.
double lowest_note_hz(const GallerySession& session) {
  const engine::NetworkDescription& network = session.world().network().description();
  const double omega = 2.0 * std::sqrt(network.links[0].stiffness / network.mats[1].mass) *
                       std::sin(std::numbers::pi / 82.0);
  return omega / (2.0 * std::numbers::pi);
}

std::uint64_t slips(const GallerySession& session) {
  return session.world().change_count(0, 0, 1);  // hooked to unhooked
}

TEST(BowedString, SlipsOncePerSwingOfTheString) {
  GallerySession session("bowed_string.yaml");
  ASSERT_EQ(session.world().network().description().state_machines.at(0).states.at(1).name,
            "unhooked");
  const double note_hz = lowest_note_hz(session);
  EXPECT_NEAR(note_hz, 4.0, 0.05);

  session.play_until(1.0);  // until the swing has settled
  const std::uint64_t at_1 = slips(session);
  session.play_until(3.0);
  const std::uint64_t at_3 = slips(session);
  EXPECT_NEAR(static_cast<double>(at_3 - at_1), 2.0 * note_hz, 1.0);

  // and so it does when the bow comes back
  session.play_until(4.0);
  const std::uint64_t at_4 = slips(session);
  session.play_until(6.0);
  EXPECT_NEAR(static_cast<double>(slips(session) - at_4), 2.0 * note_hz, 1.0);
}

TEST(BowedString, FollowsTheBowWhileItIsHooked) {
  GallerySession session("bowed_string.yaml");
  session.play_until(1.0);
  int ticks = 0;
  int hooked = 0;
  double difference = 0.0;
  session.play_until(3.0, [&] {
    ++ticks;
    if (session.world().state_of(0) != 0) return;
    ++hooked;
    difference += session.velocity("bow").x() - session.velocity("string", 5).x();
  });
  EXPECT_GT(hooked, ticks / 2);
  EXPECT_NEAR(difference / hooked, 0.0, 0.01);  // the bow goes 0.05 m/s
}

}  // namespace
}  // namespace cordis::test
