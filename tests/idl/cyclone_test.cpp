// tests/idl/cyclone_test.cpp -- another implementation of DDS in a session.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/status.h"
#include "node/time.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
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

TEST(Cyclone, FindsASessionWhenItIsGivenThePlaceAndIsForgottenWhenItDies) {
  Participant sim({test::own_domain(), "cyclone", "sim"});
  const node::StatusPublisher status(sim, msg::KIND_SIM_NODE,
                                     static_cast<std::uint64_t>(node::monotonic_nsec()),
                                     [](msg::NodeStatus& said) { said.phase(msg::PHASE_RUNNING); });

  test::ChildProcess cyclone(
      {CORDIS_CYCLONE_READER, std::to_string(test::own_domain()), "cyclone"},
      {{"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}});
  const std::string said = "sim kind " + std::to_string(msg::KIND_SIM_NODE) + " phase " +
                           std::to_string(msg::PHASE_RUNNING);
  ASSERT_TRUE(cyclone.wait_for_output(said, kPatience)) << cyclone.output();
  EXPECT_EQ(sim.peers().size(), 1u);

  cyclone.signal(SIGKILL);
  EXPECT_TRUE(comes_to_know(sim, 0));
}

TEST(Cyclone, OfAnotherVersionOfTheWireIsNotReadAnyMore) {
  Participant sim({test::own_domain(), "versions", "sim"});
  Participant pedal({test::own_domain(), "versions", "pedal"});
  Reader<msg::DeviceDescription> descriptions(sim, Topic::kDevice);
  Reader<msg::GesturePositions> positions(sim, Topic::kPositions);
  Writer<msg::GesturePositions> same(pedal, Topic::kPositions);
  const std::string version = std::to_string(msg::WIRE_VERSION + 6);
  const test::ChildProcess cyclone(
      {CORDIS_CYCLONE_READER, std::to_string(test::own_domain()), "versions", version},
      {{"CYCLONEDDS_URI", "file://" CORDIS_SOURCE_DIR "/idl/cyclonedds.xml"}});

  msg::GesturePositions received;
  EXPECT_TRUE(test::eventually([&] { return positions.take(received); })) << cyclone.output();
  EXPECT_EQ(received.device_id(), 1u) << "it has said nothing of its version that was read";
  msg::DeviceDescription description;
  EXPECT_TRUE(test::eventually([&] {
    EXPECT_FALSE(descriptions.take(description));
    return !sim.mismatch().empty();
  }));
  EXPECT_NE(sim.mismatch().find("speaks version " + version + " of the wire"), std::string::npos)
      << sim.mismatch();

  msg::GesturePositions sample;
  sample.device_id(2);
  EXPECT_TRUE(test::eventually([&] {
    sample.sample(sample.sample() + 1);
    EXPECT_TRUE(same.write(sample));
    while (positions.take(received)) EXPECT_EQ(received.device_id(), 2u);
    return received.device_id() == 2 && received.sample() > 200;
  }));
}

}  // namespace
}  // namespace cordis::dds
