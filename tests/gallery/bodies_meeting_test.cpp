// tests/gallery/bodies_meeting_test.cpp
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

/// The distances within a body.
class Shape {
 public:
  Shape(const Stage& stage, const std::string& name) : stage_(stage), body_(stage.mats(name)) {
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
        all.push_back(
            (stage_.world().position(body_.first + a) - stage_.world().position(body_.first + b))
                .norm());
      }
    }
    return all;
  }

  const Stage& stage_;
  scene::NamedRange body_;
  std::vector<double> at_first_;
};

TEST(BodiesMeeting, EachDeformsAsItsMatterDoes) {
  Stage stage("bodies_meeting.yaml");
  const Shape rigid(stage, "rigid.balls");
  const Shape plastic(stage, "plastic.balls");
  const Shape deformable(stage, "deformable.balls");
  double rigid_most = 0.0;
  double deformable_most = 0.0;
  int tick = 0;
  const auto watch = [&] {
    if (++tick % 5 != 0) return;
    rigid_most = std::max(rigid_most, rigid.deformation());
    deformable_most = std::max(deformable_most, deformable.deformation());
  };
  stage.play_until(1.34, watch);  // they have met, and have diverged again
  const double dent = plastic.deformation();
  stage.play_until(1.52, watch);  // before the next of them meets the edge

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
  Stage stage("bodies_meeting.yaml");
  const std::vector<engine::Mat>& mats = stage.world().network().description().mats;
  engine::Vec3 before = engine::Vec3::Zero();
  std::size_t touching = 0;
  stage.play_until(2.0, [&] {
    const auto is_mass = [&](std::uint32_t mat) {
      return mats[mat].kind == engine::MatKind::kMass;
    };
    const bool alone = stage.world().bound_pairs(kEdge).empty() &&
                       stage.world().bound_pairs(kPush).empty() &&
                       std::ranges::all_of(stage.events(), [&](const engine::LinkEvent& event) {
                         return is_mass(event.mat_a) && is_mass(event.mat_b);
                       });
    const engine::Vec3 now = stage.world().momentum();
    if (alone) {
      ASSERT_LT((now - before).norm(), 1.0e-13) << stage.time_s();
      for (std::size_t set = 0; set < 3; ++set) {
        touching += stage.world().bound_pairs(set).empty() ? 0 : 1;
      }
    }
    before = now;
  });
  EXPECT_GE(touching, 200u);  // ticks in which bodies touch each other and nothing else
  EXPECT_GT(before.norm(), 0.01);
  EXPECT_LT(std::abs(stage.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
