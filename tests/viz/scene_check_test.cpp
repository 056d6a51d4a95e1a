// tests/viz/scene_check_test.cpp
#include "viz_node/scene_check.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/surfaces.h"
#include "tests/viz/scenes_for_tests.h"

namespace cordis::viz {
namespace {

TEST(SceneCheck, FindsNothingWrongWithASoundScene) {
  EXPECT_EQ(fault_of(row_of_three()), "");
  EXPECT_EQ(fault_of(frame_of_three(1), row_of_three()), "");
  EXPECT_EQ(fault_of(signals_of_three(1, 5), row_of_three()), "");
}

TEST(SceneCheck, FindsWhatIsWrongWithADescription) {
  const std::vector<std::pair<const char*, std::function<void(msg::SceneDescription&)>>> faults = {
      {"radii", [](auto& d) { d.mat_radius_m().pop_back(); }},
      {"radius", [](auto& d) { d.mat_radius_m()[1] = -1.0F; }},
      {"radius", [](auto& d) { d.mat_radius_m()[1] = std::nanf(""); }},
      {"dimensions", [](auto& d) { d.space(4); }},
      {"state machines", [](auto& d) { d.link_state_machine({0}); }},
      {"odd number", [](auto& d) { d.link_ends().pop_back(); }},
      {"joins a MAT", [](auto& d) { d.link_ends()[3] = 3; }},
      {"port",
       [](auto& d) {
         d.ports().resize(1);
         d.ports()[0].mat(3);
       }},
      {"name",
       [](auto& d) {
         d.matter().resize(1);
         d.matter()[0].first(1);
         d.matter()[0].count(3);
       }},
      {"name",
       [](auto& d) {
         d.links().resize(1);
         d.links()[0].first(0xffffffff);
         d.links()[0].count(2);  // would wrap round in 32 bits
       }},
      {"colour",
       [](auto& d) {
         d.colours().resize(1);
         d.colours()[0].first(0xffffffff);
         d.colours()[0].count(2);  // would wrap round in 32 bits
       }},
      {"masses", [](auto& d) { d.mat_mass_kg().pop_back(); }},
      {"rate", [](auto& d) { d.step_rate_hz(0.0); }},
      {"rate", [](auto& d) { d.frame_rate_hz(std::numeric_limits<double>::infinity()); }},
      {"too many signals", [](auto& d) { d.signals().resize(kMaxSignals + 1); }},
      {"too many surfaces",
       [](auto& d) { d.surfaces().assign(kMaxSurfaces + 1, test::steps_and_post()[0]); }},
      {"surface", [](auto& d) { d.surfaces()[0].centre_m().pop_back(); }},
      {"surface",
       [](auto& d) {
         d.surfaces()[0].axis({0.0, 2.0, 0.0});
       }},
      {"surface", [](auto& d) { d.surfaces()[2].size_m()[1] = -1.0; }},
      {"surface", [](auto& d) { d.surfaces()[2].centre_m()[0] = std::nan(""); }},
      {"surface", [](auto& d) { d.surfaces()[5].axis().clear(); }},
      {"surface", [](auto& d) { d.surfaces()[5].size_m()[0] = 0.0; }},
      {"surface", [](auto& d) { d.surfaces()[5].kind(static_cast<msg::SurfaceKind>(9)); }},
      {"surface", [](auto& d) { d.surfaces()[0].kind(msg::SURFACE_HOLLOW_BOX); }},
      {"surface", [](auto& d) { d.surfaces()[0].kind(msg::SURFACE_HOLLOW_CYLINDER); }},
      {"MATs of surfaces", [](auto& d) { d.surface_mat().pop_back(); }},
      {"does not exist", [](auto& d) { d.surface_mat()[5] = 3; }},
      {"state machine", [](auto& d) { d.sets({bonding_set(0, 0)}); }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneDescription description = row_of_three();
    description.surfaces(test::steps_and_post());
    description.surface_mat({0, 1, 2, 0, 1, 2});
    ASSERT_EQ(fault_of(description), "");
    spoil(description);
    EXPECT_NE(fault_of(description).find(word), std::string::npos)
        << word << ": '" << fault_of(description) << "'";
  }
}

TEST(SceneCheck, FindsFramesThatDoNotFitTheirDescription) {
  const std::vector<std::pair<const char*, std::function<void(msg::SceneFrame&)>>> faults = {
      {"coordinates", [](auto& f) { f.position_m().pop_back(); }},
      {"coordinates", [](auto& f) { f.position_m().clear(); }},
      {"link states", [](auto& f) { f.link_state({0}); }},
      {"finite", [](auto& f) { f.position_m()[8] = std::numeric_limits<float>::infinity(); }},
      {"simulated time", [](auto& f) { f.simulated_s(std::nan("")); }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneFrame frame = frame_of_three(1);
    spoil(frame);
    EXPECT_NE(fault_of(frame, row_of_three()).find(word), std::string::npos) << word;
  }
}

TEST(SceneCheck, FindsBondsAndForcesThatDoNotFitTheirDescription) {
  ASSERT_EQ(fault_of(bonding_row()), "");
  msg::SceneFrame good = frame_of_three(1);
  EXPECT_EQ(fault_of(good, bonding_row()), "") << "as in an older take";
  good.bond_ends({0, 1, 1, 2});
  good.bond_state({1, 130});
  good.bond_count({0, 2});
  good.port_force_n({0.0F, 1.0F, 0.0F});
  ASSERT_EQ(fault_of(good, bonding_row()), "");

  const std::vector<std::pair<const char*, std::function<void(msg::SceneFrame&)>>> faults = {
      {"ends of bonds", [](auto& f) { f.bond_ends().pop_back(); }},
      {"ends of bonds", [](auto& f) { f.bond_state().pop_back(); }},
      {"does not exist", [](auto& f) { f.bond_ends()[2] = 3; }},
      {"sets in a frame", [](auto& f) { f.bond_count().pop_back(); }},
      {"bonds of sets", [](auto& f) { f.bond_count().clear(); }},
      {"bonds of sets", [](auto& f) { f.bond_count()[0] = 1; }},
      {"bonds of sets",
       [](auto& f) {
         f.bond_count({0xffffffff, 3});
       }},  // would wrap round
      {"forces on ports", [](auto& f) { f.port_force_n().pop_back(); }},
      {"finite", [](auto& f) { f.port_force_n()[1] = std::nanf(""); }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneFrame frame = good;
    spoil(frame);
    EXPECT_NE(fault_of(frame, bonding_row()).find(word), std::string::npos) << word;
  }
}

TEST(SceneCheck, FindsEventsOfWhatDoesNotExist) {
  msg::SceneEvents events;
  events.event().resize(2);
  events.event()[1].link(msg::NO_INDEX);
  events.event()[1].mat_b(2);
  EXPECT_EQ(fault_of(events, row_of_three()), "");

  const std::vector<std::pair<const char*, std::function<void(msg::SceneEvents&)>>> faults = {
      {"does not exist", [](auto& e) { e.event()[0].link(2); }},
      {"does not exist", [](auto& e) { e.event()[1].mat_a(3); }},
      {"does not exist", [](auto& e) { e.event()[0].mat_b(3); }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneEvents bad = events;
    spoil(bad);
    EXPECT_NE(fault_of(bad, row_of_three()).find(word), std::string::npos) << word;
  }
}

TEST(SceneCheck, FindsBatchesThatAreNoWholeRows) {
  const std::vector<std::pair<const char*, std::function<void(msg::SceneSignals&)>>> faults = {
      {"signals", [](auto& s) { s.signal_count(3); }},
      {"values", [](auto& s) { s.value().pop_back(); }},
      {"values", [](auto& s) { s.value().resize(kMaxBatchValues + 2); }},
      {"no steps", [](auto& s) { s.stride_steps(0); }},
      {"steps of rows",
       [](auto& s) {
         s.row_step({0, 2, 4, 6});
       }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneSignals signals = signals_of_three(1, 5);
    spoil(signals);
    EXPECT_NE(fault_of(signals, row_of_three()).find(word), std::string::npos) << word;
  }
}

TEST(SceneCheck, FindsBlocksOfSoundThatAreNoWholeSteps) {
  EXPECT_EQ(fault_of(sound_of_row(1, 5), sounding_row()), "");
  EXPECT_NE(fault_of(sound_of_row(1, 5), row_of_three()), "") << "it has no sound";
  const std::vector<std::pair<const char*, std::function<void(msg::SceneSound&)>>> faults = {
      {"sounds", [](auto& s) { s.sound_count(2); }},
      {"sounds", [](auto& s) { s.sound_count(0); }},
      {"values", [](auto& s) { s.value().resize(kMaxBatchValues + 1); }},
      {"rate", [](auto& s) { s.step_rate_hz(0.0); }},
      {"rate", [](auto& s) { s.step_rate_hz(std::nan("")); }},
  };
  for (const auto& [word, spoil] : faults) {
    msg::SceneSound sound = sound_of_row(1, 5);
    spoil(sound);
    EXPECT_NE(fault_of(sound, sounding_row()).find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace cordis::viz
