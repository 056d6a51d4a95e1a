// tests/gallery/bodies_meeting_test.cpp
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// The distances within a body.
class Shape {
 public:
  Shape(const GallerySession& session, const std::string& name)
      : session_(session), body_(session.mats(name)) {
    at_first_ = distances();
  }

  /// Largest change of a distance since the start, relative to it.
  double deformation() const {
    const std::vector<double> now = distances();
    double largest = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      largest = std::max(largest, std::abs(now[i] / at_first_[i] - 1.0));
    }
    return largest;
  }

 private:
  std::vector<double> distances() const {
    std::vector<double> all;
    for (std::uint32_t a = 0; a < body_.count; ++a) {
      for (std::uint32_t b = 0; b < a; ++b) {
        all.push_back((session_.world().position(body_.first + a) -
                       session_.world().position(body_.first + b))
                          .norm());
      }
    }
    return all;
  }

  const GallerySession& session_;
  scene::NamedRange body_;
  std::vector<double> at_first_;
};

TEST(BodiesMeeting, EachDeformsAsItsMatterDoes) {
  GallerySession session("bodies_meeting.yaml");
  const Shape rigid(session, "rigid.balls");
  const Shape plastic(session, "plastic.balls");
  const Shape deformable(session, "deformable.balls");
  double rigid_most = 0.0;
  double deformable_most = 0.0;
  int tick = 0;
  const auto watch = [&] {
    if (++tick % 5 != 0) return;
    rigid_most = std::max(rigid_most, rigid.deformation());
    deformable_most = std::max(deformable_most, deformable.deformation());
  };
  session.play_until(1.34, watch);  // they have met, and have diverged again
  const double dent = plastic.deformation();
  session.play_until(1.52, watch);  // before the next of them meets the edge

  RecordProperty("rigid, at most", std::to_string(rigid_most));
  RecordProperty("deformable, at most", std::to_string(deformable_most));
  RecordProperty("deformable, afterwards", std::to_string(deformable.deformation()));
  EXPECT_LT(rigid_most, 0.02);
  EXPECT_LT(rigid.deformation(), 1.0e-5);
  EXPECT_GT(deformable_most, 0.3);
  EXPECT_LT(deformable.deformation(), 0.005);
  EXPECT_GT(dent, 0.5);
  EXPECT_NEAR(plastic.deformation(), dent, 0.001);
}

TEST(BodiesMeeting, ExchangesMomentumAndLosesNone) {
  constexpr std::size_t kEdge = 4;  // the sets of the scene
  constexpr std::size_t kPush = 5;
  GallerySession session("bodies_meeting.yaml");
  const std::vector<engine::Mat>& mats = session.world().network().description().mats;
  engine::Vec3 before = engine::Vec3::Zero();
  std::size_t touching = 0;
  session.play_until(2.0, [&] {
    const auto is_mass = [&](std::uint32_t mat) {
      return mats[mat].kind == engine::MatKind::kMass;
    };
    const bool alone = session.world().bound_pairs(kEdge).empty() &&
                       session.world().bound_pairs(kPush).empty() &&
                       std::ranges::all_of(session.events(), [&](const engine::LinkEvent& event) {
                         return is_mass(event.mat_a) && is_mass(event.mat_b);
                       });
    const engine::Vec3 now = session.world().momentum();
    if (alone) {
      ASSERT_LT((now - before).norm(), 1.0e-13) << session.time_s();
      for (std::size_t set = 0; set < 3; ++set) {
        touching += session.world().bound_pairs(set).empty() ? 0 : 1;
      }
    }
    before = now;
  });
  EXPECT_GE(touching, 200u);  // ticks in which bodies touch each other and nothing else
  EXPECT_GT(before.norm(), 0.01);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
