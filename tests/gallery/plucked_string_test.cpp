// tests/gallery/plucked_string_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(PluckedString, SwingsOnWhenTheHandHasLetGo) {
  GallerySession session("plucked_string.yaml");
  double highest_force = 0.0;
  session.play_until(
      1.9, [&] { highest_force = std::max(highest_force, std::abs(session.signal("key_force"))); });
  EXPECT_GT(highest_force, 0.5);

  double swing = 0.0;
  session.play_until(2.2);
  session.play_until(3.2, [&] { swing = std::max(swing, std::abs(session.signal("middle_y"))); });
  EXPECT_GT(swing, 0.002);
}

}  // namespace
}  // namespace cordis::test
