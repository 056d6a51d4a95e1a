// tests/integration/sessions_test.cpp -- two sessions side by side in one domain.
#include <cmath>

#include <gtest/gtest.h>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/integration/scenes.h"
#include "tests/integration/status_watch.h"

namespace cordis::test {
namespace {

TEST(Sessions, OfOneDomainDoNotHearEachOther) {
  // Domain and names of nodes and devices are equal; only the sessions' names and the stiffness
  // differ.
  LiveSession soft("realtime", kSimAndKey, "soft");
  LiveSession stiff("realtime", kSimAndKey, "stiff");
  soft.add_file("scene.yaml", wall_scene(100.0));
  stiff.add_file("scene.yaml", wall_scene(300.0));
  for (LiveSession* session : {&soft, &stiff}) {
    session->add_file("key.yaml", steady_key(-0.01, 0.0));
    session->start("sim_node", "sim");
    session->start("device_node", "keyboard");
  }
  dds::Reader<msg::GestureForces> soft_forces(soft.participant(), dds::Topic::kForces);
  dds::Reader<msg::GestureForces> stiff_forces(stiff.participant(), dds::Topic::kForces);

  msg::GestureForces force;
  std::uint64_t soft_run = 0;
  std::uint64_t stiff_run = 0;
  const auto watch = [&force](auto& reader, double settled, std::uint64_t& run) {
    bool reached = false;
    while (reader.take(force)) {
      if (run == 0) run = force.epoch();
      EXPECT_EQ(force.epoch(), run) << "a force of the other session";
      EXPECT_LE(force.force_n()[0], settled + 1e-9);
      reached = reached || std::abs(force.force_n()[0] - settled) < 1e-9;
    }
    return reached;
  };
  bool soft_reached = false;
  bool stiff_reached = false;
  ASSERT_TRUE(eventually([&] {
    soft_reached = watch(soft_forces, 1.0, soft_run) || soft_reached;
    stiff_reached = watch(stiff_forces, 3.0, stiff_run) || stiff_reached;
    return soft_reached && stiff_reached;
  }));
  EXPECT_NE(soft_run, stiff_run);
}

}  // namespace
}  // namespace cordis::test
