// tests/gallery/maxwells_demon_test.cpp
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// The balls of a room, and their mean kinetic energy [J].
struct Room {
  int count = 0;
  double energy = 0.0;
};

struct Rooms {
  Room left;
  Room right;
};

Rooms rooms_of(const GallerySession& session) {
  constexpr double kMass = 0.001;
  Rooms rooms;
  for (const char* gas : {"left.gas", "right.gas"}) {
    for (std::uint32_t i = 0; i < session.mats(gas).count; ++i) {
      Room& room = session.position(gas, i).x() < 0.0 ? rooms.left : rooms.right;
      ++room.count;
      room.energy += 0.5 * kMass * session.velocity(gas, i).squaredNorm();
    }
  }
  rooms.left.energy /= rooms.left.count;
  rooms.right.energy /= rooms.right.count;
  return rooms;
}

TEST(MaxwellsDemon, HeatsTheRightRoomWithoutWork) {
  GallerySession session("maxwells_demon.yaml");
  session.play_until(0.01);
  const double energy = session.signal("energy");
  const Rooms before = rooms_of(session);
  EXPECT_EQ(before.left.count, before.right.count);

  // Over many moments, for a room of 30 balls has a temperature that swings.
  Room left;
  Room right;
  int moments = 0;
  int largest = before.right.count;
  session.play_until(20.0);
  session.play_until(24.0, [&] {
    const Rooms now = rooms_of(session);
    EXPECT_GE(now.right.count, largest) << "nothing comes back";
    largest = now.right.count;
    left.energy += now.left.energy;
    right.energy += now.right.energy;
    ++moments;
  });
  EXPECT_GT(largest, 75);
  EXPECT_GT(right.energy / moments, 1.2 * left.energy / moments);
  EXPECT_NEAR(session.signal("energy"), energy, 0.01 * energy);
  EXPECT_EQ(session.signal("switching_energy"), 0.0);
}

}  // namespace
}  // namespace cordis::test
