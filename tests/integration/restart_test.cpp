// tests/integration/restart_test.cpp -- any node may die and be restarted while the others go on.
#include <csignal>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/scene.h"
#include "node/config/name_hash.h"
#include "node/dds/writer.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

/// sim, keyboard and view of one session, all running.
class Restart : public ::testing::TestWithParam<const char*> {
 protected:
  Restart()
      : session_(GetParam(), std::string(kSimAndKey) + "  view: {node: viz_node, port: 0}\n"),
        status_(session_.participant()) {
    session_.add_file("scene.yaml", wall_scene(200.0));
    session_.add_file("key.yaml", steady_key(-0.01, 0.0));
    session_.start("sim_node", "sim");
    session_.start("device_node", "keyboard");
    session_.start("viz_node", "view");
  }

  void SetUp() override {
    ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
    ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
    ASSERT_TRUE(status_.wait_for("view", serves_a_page));
  }

  static bool serves_a_page(const msg::NodeStatus& status) {
    return status.text().find("http://") != std::string::npos;
  }

  void kill_now(const std::string& name) {
    session_.node(name).signal(SIGKILL);
    ASSERT_EQ(session_.node(name).wait(kPatience), 128 + SIGKILL);
  }

  /// The node has done at least `more` ticks since now.
  bool goes_on(const std::string& name, std::uint64_t more) {
    const std::uint64_t sequence = status_.of(name).sequence_number();
    if (!status_.wait_for(name,
                          [&](const auto& status) { return status.sequence_number() > sequence; }))
      return false;
    const std::uint64_t ticks = status_.of(name).ticks();
    return status_.wait_for(name,
                            [&](const auto& status) { return status.ticks() > ticks + more; });
  }

  bool restarts(const std::string& name, std::uint64_t old_epoch) {
    return status_.wait_for(name, [&](const auto& status) {
      return status.epoch() != old_epoch && status.phase() == msg::PHASE_RUNNING;
    });
  }

  LiveSession session_;
  StatusWatch status_;
};

TEST_P(Restart, OfSimLeavesTheDeviceWithoutForceUntilItIsBack) {
  const std::uint64_t old_epoch = status_.of("sim").epoch();
  kill_now("sim");

  ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_LOST));

  session_.start("sim_node", "sim");
  ASSERT_TRUE(restarts("sim", old_epoch));
  ASSERT_TRUE(status_.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  EXPECT_TRUE(goes_on("sim", 100));
  EXPECT_TRUE(goes_on("keyboard", 100));
}

TEST_P(Restart, OfTheDeviceFindsTheSceneStillThere) {
  const std::uint64_t old_epoch = status_.of("keyboard").epoch();
  const std::uint64_t sim_epoch = status_.of("sim").epoch();
  kill_now("keyboard");
  if (GetParam() == std::string("realtime")) {
    ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_WAITING));
    EXPECT_TRUE(goes_on("sim", 100)) << "the scene goes on without a hand";
  }

  session_.start("device_node", "keyboard");

  ASSERT_TRUE(restarts("keyboard", old_epoch));
  ASSERT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
  EXPECT_TRUE(goes_on("sim", 100));
  EXPECT_EQ(status_.of("sim").epoch(), sim_epoch);
}

TEST_P(Restart, OfTheDisplayDisturbsNobody) {
  const std::uint64_t old_epoch = status_.of("view").epoch();
  kill_now("view");
  EXPECT_TRUE(goes_on("sim", 100));
  EXPECT_TRUE(goes_on("keyboard", 100));

  session_.start("viz_node", "view");

  ASSERT_TRUE(status_.wait_for("view", [&](const auto& status) {
    return status.epoch() != old_epoch && serves_a_page(status);
  }));
  EXPECT_TRUE(status_.wait_for_phase("sim", msg::PHASE_RUNNING));
}

INSTANTIATE_TEST_SUITE_P(Clocks, Restart, ::testing::Values("realtime", "lockstep"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(Lockstep, WhoWaitsLongSaysForWhomAndWhetherAnybodyIsThereAndForgetsNobody) {
  LiveSession session("lockstep", kSimAndKey);
  session.add_file("scene.yaml", wall_scene(200.0));
  session.add_file("key.yaml", steady_key(-0.01, 0.0));
  StatusWatch status(session.participant());
  LiveSession sceneless("lockstep", kSimAndKey, "sceneless");
  sceneless.add_file("scene.yaml", wall_scene(200.0));
  sceneless.add_file("key.yaml", steady_key(-0.01, 0.0));
  dds::Writer<msg::SceneDescription> scenes(sceneless.participant(), dds::Topic::kDescription);
  msg::SceneDescription scene;
  scene.epoch(1);
  scene.version(1);
  scene.ports().emplace_back();
  scene.ports().back().device_id(config::name_hash("keyboard"));
  scene.ports().back().axes({0});
  EXPECT_TRUE(scenes.write(scene));

  ChildProcess& sim = session.start("sim_node", "sim");
  ChildProcess& alone = sceneless.start("device_node", "keyboard");

  EXPECT_TRUE(sim.wait_for_output(
      "waiting for the device 'keyboard' for 2 s: no device_node of the session is alive; "
      "nothing moves until it plays port 'key'",
      kPatience));
  EXPECT_TRUE(alone.wait_for_output(
      "no answer to the first sample for 2 s: no sim_node of the session is alive", kPatience));

  dds::Writer<msg::NodeStatus> elsewhere(session.participant(), dds::Topic::kStatus);
  msg::NodeStatus other;
  other.node_id(1);
  other.node("other");
  other.kind(msg::KIND_DEVICE_NODE);
  other.phase(msg::PHASE_RUNNING);
  ChildProcess& device = session.start("device_node", "keyboard");
  ASSERT_TRUE(status.wait_for_phase("keyboard", msg::PHASE_RUNNING));
  device.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] {
    other.sequence_number(other.sequence_number() + 1);
    EXPECT_TRUE(elsewhere.write(other));
    return sim.output().find("2 s: device_node 'other' is alive, and sends no sample") !=
           std::string::npos;
  })) << "the one that is stopped is not";
  device.signal(SIGCONT);

  const std::uint64_t ticks = status.of("keyboard").ticks();
  EXPECT_TRUE(status.wait_for("keyboard", [&](const auto& s) { return s.ticks() > ticks + 100; }));
}

}  // namespace
}  // namespace cordis::test
