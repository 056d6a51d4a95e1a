// tests/idl/cyclone_test.cpp -- another implementation of DDS in a session.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "node/status.h"
#include "node/time.h"
#include "tests/support/child_process.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 60s;

bool comes_to_know(const Participant& participant, std::size_t others) {
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (participant.peers().size() != others) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

TEST(Cyclone, FindsASessionWhenItIsToldWhereAndIsForgottenWhenItDies) {
  Participant sim({test::own_domain(), "cyclone", "sim"});
  const node::StatusPublisher status(sim, "sim_node",
                                     static_cast<std::uint64_t>(node::monotonic_nsec()),
                                     [](msg::NodeStatus& said) { said.phase("running"); });

  test::ChildProcess cyclone(
      {CORDIS_CYCLONE_READER, std::to_string(test::own_domain()), "cyclone"},
      {{"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}});
  ASSERT_TRUE(cyclone.wait_for_output("sim sim_node running", kPatience)) << cyclone.output();
  EXPECT_EQ(sim.peers().size(), 1u);

  cyclone.signal(SIGKILL);
  EXPECT_TRUE(comes_to_know(sim, 0));
}

}  // namespace
}  // namespace cordis::dds
