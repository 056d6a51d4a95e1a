// tests/integration/pointer_test.cpp -- a hand on a page takes over from a simulated one, and hands
// back, with real processes. The test is the viz_node.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/config/name_hash.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/time.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"

namespace cordis::test {
namespace {

constexpr double kWall = 200.0;    // [N/m]
constexpr double kTarget = -0.02;  // where the hand on the page wants it [m]

/// One key: a script presses it to -5 mm, and a pointer may take over.
class PointerTakesOver : public ::testing::Test {
 protected:
  PointerTakesOver()
      : session_("realtime",
                 R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml, driver: script, script: {positions: [{at_s: 0, m: -0.005}]}}
  pointer: {node: device_node, device: key.yaml, driver: pointer, standby_for: keyboard, strength: 20, clock: realtime, required: false}
)"),
        targets_(session_.participant(), dds::Topic::kPointerTarget),
        states_(session_.participant(), dds::Topic::kPointerState),
        status_(session_.participant(), dds::Topic::kStatus),
        signals_(session_.participant(), dds::Topic::kSignals) {
    session_.add_file("scene.yaml",
                      wall_scene(kWall) + "signals: {place: {of: key, quantity: position}}\n");
    session_.add_file("key.yaml",
                      R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
force_limit_n: 5
mock: {hand: {stiffness_n_per_m: 400, finger: {holds: true}}}
)");
    for (const std::string name : {"keyboard", "pointer"}) session_.start("device_node", name);
    session_.start("sim_node", "sim");
  }

  void say(bool holds) {
    msg::PointerTarget target;
    target.device_id(config::name_hash("keyboard"));
    target.epoch(1);
    target.sequence_number(++number_);
    target.time_nsec(node::monotonic_nsec());
    target.holds(holds);
    target.held_coordinates(1);
    target.coordinate_count(1);
    target.target_m()[0] = kTarget;
    ASSERT_TRUE(targets_.write(target));
  }

  void listen() {
    msg::PointerState state;
    while (states_.take(state)) state_ = state;
    msg::NodeStatus status;
    while (status_.take(status)) phases_[status.node()] = status.phase();
    msg::SceneSignals batch;
    while (signals_.take(batch)) {
      const bool goes_on = batch.batch() == batch_ + 1 && batch.dropped_rows() == 0;
      batch_ = batch.batch();
      for (std::size_t row = 0; row < batch.value().size(); ++row) {
        const double place_m = batch.value()[row];
        if (row > 0 || goes_on) fastest_m_ = std::max(fastest_m_, std::abs(place_m - place_m_));
        place_m_ = place_m;
        ++rows_;
      }
    }
  }

  bool are(msg::NodePhase keyboard, msg::NodePhase pointer) {
    listen();
    return phases_["keyboard"] == keyboard && phases_["pointer"] == pointer;
  }

  LiveSession session_;
  dds::Writer<msg::PointerTarget> targets_;
  dds::Reader<msg::PointerState> states_;
  dds::Reader<msg::NodeStatus> status_;
  dds::Reader<msg::SceneSignals> signals_;
  std::uint64_t batch_ = 0;
  std::uint64_t rows_ = 0;
  double place_m_ = 0.0;    // of the port
  double fastest_m_ = 0.0;  // largest way of the port in one period
  std::uint64_t number_ = 0;
  msg::PointerState state_;
  std::map<std::string, msg::NodePhase> phases_;
};

TEST_F(PointerTakesOver, WhileItHoldsAndHandsBackWhenItIsSilent) {
  ASSERT_TRUE(eventually([&] { return are(msg::PHASE_RUNNING, msg::PHASE_STANDBY); }))
      << "the script plays";

  // The wall pushes with F = -k x, and hand and finger stay behind: x = target + F / 400 + F / 2000.
  const double balance = kTarget / (1.0 + kWall / 400.0 + kWall / 2000.0);
  const double friction = 0.05 / kWall;  // of the key, more than the balance can be off [m]
  ASSERT_TRUE(eventually([&] {
    say(true);
    return are(msg::PHASE_STANDBY, msg::PHASE_RUNNING) && state_.holds() &&
           std::abs(state_.position_m()[0] - balance) < friction &&
           std::abs(state_.force_n()[0] + kWall * balance) < 0.1;
  })) << "the hand on the page plays, and feels the wall";
  EXPECT_NEAR(state_.target_m()[0], kTarget, 1e-6);
  EXPECT_GT(state_.felt_number(), 0u);
  EXPECT_LE(state_.felt_number(), number_);
  EXPECT_EQ(state_.followed_epoch(), 1u);

  ASSERT_TRUE(eventually([&] { return are(msg::PHASE_RUNNING, msg::PHASE_STANDBY); }))
      << "silence lets go, and the script plays again";
  EXPECT_FALSE(state_.holds());

  ASSERT_TRUE(eventually([&] {
    say(true);
    return are(msg::PHASE_STANDBY, msg::PHASE_RUNNING);
  })) << "and so once more";
  say(false);
  ASSERT_TRUE(eventually([&] { return are(msg::PHASE_RUNNING, msg::PHASE_STANDBY); }))
      << "a word lets go as well";

  // From the key of the script to that of the pointer it is 7 mm. A takeover leads the port there within
  // 0.1 s, and a hand moves at 1 m/s at most.
  EXPECT_GT(rows_, 100u);
  EXPECT_LT(fastest_m_, 0.002) << "the port jumped";
}

}  // namespace
}  // namespace cordis::test
