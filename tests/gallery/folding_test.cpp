// tests/gallery/folding_test.cpp
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr const char* kFolding = "folding.yaml";
constexpr double kDrawn = 1.3;         // [s]: all fingers are at the far end of their strokes
constexpr double kBack = 2.6;          // [s]: all have been back for a while
constexpr double kBladeLength = 0.14;  // of tape and strip, from crease to thread [m]

/// What is seen of a signal and of the changes of a liaison.
struct Changes {
  /// Size of the signal before the first change of state of the liaison.
  double before_change = 0.0;
  /// Its largest size.
  double largest = 0.0;
  /// What the changes of that liaison bring in [J].
  double energy = 0.0;
};

Changes changes_until(GallerySession& session, double time_s, const std::string& liaison,
                      const std::string& signal) {
  Changes changes;
  double last = 0.0;
  bool has_changed = false;
  const auto& machines = session.world().network().description().state_machines;
  session.play_until(time_s, [&] {
    for (const engine::LinkEvent& event : session.events()) {
      if (machines[event.state_machine].name != liaison) continue;
      if (!has_changed) changes.before_change = last;
      has_changed = true;
      changes.energy += event.energy;
    }
    last = std::abs(session.signal(signal));
    changes.largest = std::max(changes.largest, last);
  });
  return changes;
}

TEST(Folding, ASwitchSnapsAtTheForceOfItsAngleAtRestAndForNothing) {
  constexpr double kStiffness = 0.1;  // [N m]
  constexpr double kRest = 0.5;       // [rad], either way
  constexpr double kLever = 0.05;     // [m]
  const double most = kStiffness * std::sin(kRest) / kLever;
  const double stored = kStiffness * (1.0 - std::cos(kRest));
  GallerySession session(kFolding);
  const Changes changes = changes_until(session, kDrawn, "snap", "thumb_force");
  EXPECT_NEAR(changes.before_change, most, 0.02 * most);
  EXPECT_LT(std::abs(changes.energy), 0.001 * stored);
  EXPECT_NEAR(session.signal("switch_angle"), kRest, 0.01);
  EXPECT_LT(std::abs(session.signal("thumb_force")), 0.02 * most) << "it stays by itself";

  const ChangedScene changed("folding", {{", rest_rad: 0.5", ""}});
  GallerySession with_one_rest(kFolding, changed.overrides());
  with_one_rest.play_until(kDrawn);
  EXPECT_GT(std::abs(with_one_rest.signal("thumb_force")), 0.9 * most) << "the thumb holds it";
}

TEST(Folding, ATapeGivesWayAtTheForceOfItsKinkAndIsStraightAgain) {
  const double most = 2.8 * std::sin(0.03) / kBladeLength;
  GallerySession session(kFolding);
  const Changes changes = changes_until(session, kDrawn, "steel", "index_force");
  EXPECT_NEAR(changes.before_change, most, 0.02 * most);
  EXPECT_GT(std::abs(session.signal("kink_bend")), 0.4);
  EXPECT_NEAR(session.signal("kink_moment"), 0.02 * std::sin(session.signal("kink_bend")), 1e-4);
  EXPECT_LT(std::abs(session.signal("index_force")), 0.2 * most) << "it folds with little force";
  EXPECT_EQ(session.signal("kink_state"), 1.0);
  session.play_until(kBack);
  EXPECT_LT(std::abs(session.signal("kink_bend")), 1e-6);
  EXPECT_EQ(session.signal("kink_state"), 0.0);

  const ChangedScene changed("folding",
                             {{"stiffness_n_m_per_rad: 0.02", "stiffness_n_m_per_rad: 2.8"}});
  GallerySession stiff(kFolding, changed.overrides());
  stiff.play_until(kDrawn);
  EXPECT_GT(std::abs(stiff.signal("index_force")), 2.0 * most);
}

TEST(Folding, ASwitchSwingsForLongWithoutTheViscosityOfItsStates) {
  constexpr double kSeen = 0.1;  // [s]
  GallerySession session(kFolding);
  session.play_until(kDrawn);
  const double still = session.range_until(kDrawn + kSeen, "switch_angle");
  const ChangedScene changed("folding",
                             {{"viscosity_n_m_s_per_rad: 0.001", "viscosity_n_m_s_per_rad: 0"}});
  GallerySession undamped(kFolding, changed.overrides());
  undamped.play_until(kDrawn);
  EXPECT_GT(undamped.range_until(kDrawn + kSeen, "switch_angle"), 10.0 * still);
}

TEST(Folding, TinGivesWayAtTheForceOfItsYieldAngleSpringsBackByItAndTakesTheWork) {
  constexpr double kStiffness = 1.25;  // [N m]
  constexpr double kYield = 0.04;      // [rad]
  constexpr double kGives = kYield / 20.0;
  const double most = kStiffness * std::sin(kYield) / kBladeLength;
  GallerySession session(kFolding);
  const Changes of_force = changes_until(session, 0.5, "tin", "middle_force");
  EXPECT_NEAR(of_force.before_change, most, 0.02 * most);

  GallerySession again(kFolding);
  const Changes of_angle = changes_until(again, kBack, "tin", "crease_angle");
  const double fold = std::abs(again.signal("fold"));
  EXPECT_GT(fold, 0.4);
  EXPECT_NEAR(of_angle.largest, fold + kYield, kGives);
  EXPECT_NEAR(std::abs(again.signal("crease_angle")), fold, kGives) << "it rests there";
  const double taken = kStiffness * (kYield - 0.5 * kGives) * fold;
  EXPECT_NEAR(-of_angle.energy, taken, 0.002 * taken);

  const ChangedScene changed("folding",
                             {{", rest: rest_rad + sign(bend_rad) * yield_rad / 20", ""}});
  GallerySession elastic(kFolding, changed.overrides());
  elastic.play_until(kBack);
  EXPECT_EQ(elastic.signal("fold"), 0.0);
  EXPECT_LT(std::abs(elastic.signal("crease_angle")), kGives) << "it is straight again";
}

}  // namespace
}  // namespace cordis::test
