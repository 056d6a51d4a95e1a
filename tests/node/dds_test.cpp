// tests/node/dds_test.cpp
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "node/dds/old_inputs.h"
#include "node/dds/payload.h"
#include "node/dds/reader.h"
#include "node/dds/wire_version.h"
#include "node/dds/writer.h"
#include "node/roster.h"
#include "node/status.h"
#include "node/time.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

using namespace std::chrono_literals;

using test::eventually;
using test::kPatience;

ParticipantConfig member(const std::string& session, const std::string& node,
                         bool lockstep = false) {
  return {test::own_domain(), session, node, lockstep};
}

template <class Message>
bool receive(Reader<Message>& reader, Message& message) {
  return eventually(
      [&] { return reader.take(message) || (reader.wait(100ms) && reader.take(message)); });
}

msg::GesturePositions sample_of(std::uint32_t device, std::uint64_t number) {
  msg::GesturePositions sample;
  sample.device_id(device);
  sample.sample(number);
  sample.axis_count(16);
  for (std::size_t axis = 0; axis < 16; ++axis)
    sample.position_m()[axis] = 0.001 * static_cast<double>(axis + 1);
  return sample;
}

TEST(Payload, OfAGestureOfWireVersion2IsReadWithoutTheDelayOfItsAnswer) {
  msg::GesturePositions sample = sample_of(5, 7);
  sample.answer_delay_s(0.25);
  std::vector<std::byte> payload = encode(sample);
  msg::GesturePositions read;
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.answer_delay_s(), 0.25);

  payload.resize(payload.size() - sizeof(double));
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.answer_delay_s(), 0.0);
  EXPECT_EQ(read.position_m(), sample.position_m());

  payload.pop_back();
  EXPECT_FALSE(decode(payload, read)) << "cut short";
}

TEST(Payload, OfADescriptionOfAnOlderWireVersionIsReadWithoutWhatItLacks) {
  for (const char* file : {"s", "sc", "sce", "scen"}) {  // each alignment of what follows
    msg::SceneDescription description;
    description.scene_file(file);
    for (const std::uint32_t version : {3u, 4u, 5u, 7u, 8u, 9u}) {
      description.wire_version(version);
      std::vector<std::byte> payload = encode(description);
      msg::SceneDescription read;
      ASSERT_TRUE(decode(payload, read));
      for (const std::uint32_t last : {8u, 7u, 5u, 4u, 3u}) {
        // the count of `sets`, `surface_mat`, `colours`, `surfaces`, `port_frames`
        payload.resize(payload.size() - 4);
        EXPECT_EQ(decode(payload, read), version <= last) << file << ", version " << version;
        if (version > last) continue;
        EXPECT_EQ(read.scene_file(), file);
        EXPECT_TRUE(read.sets().empty());
        EXPECT_TRUE(last == 8u || read.surface_mat().empty());
        EXPECT_TRUE(last >= 7u || read.colours().empty());
        EXPECT_TRUE(last >= 5u || read.surfaces().empty());
        EXPECT_TRUE(last >= 4u || read.port_frames().empty());
      }
    }
  }
}

TEST(Payload, OfADescriptionOfAnOlderWireVersionKeepsWhatItHas) {
  msg::SceneDescription description;
  description.wire_version(4);
  description.scene_file("s");
  description.port_frames().resize(2);
  description.port_frames()[1].direction({0.0, 1.0, 0.5});
  std::vector<std::byte> payload = encode(description);
  payload.resize(payload.size() - 16);  // the counts of `surfaces` and of what follows it
  msg::SceneDescription read;
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.port_frames(), description.port_frames());

  description.wire_version(5);
  description.surfaces().resize(1);
  description.surfaces()[0].size_m({0.25, 0.5, 0.125});
  payload = encode(description);
  payload.resize(payload.size() - 12);  // the counts of `colours` and of what follows it
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.surfaces(), description.surfaces());

  description.wire_version(7);
  description.colours().resize(1);
  description.colours()[0].red(77);
  payload = encode(description);
  payload.resize(payload.size() -
                 9);  // the counts of `surface_mat` and `sets`, and what aligns them
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.surfaces(), description.surfaces());
  EXPECT_EQ(read.colours(), description.colours());

  description.wire_version(8);
  description.surface_mat({3});
  payload = encode(description);
  payload.resize(payload.size() - 4);  // the count of `sets`
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.surface_mat(), description.surface_mat());
}

/// A payload, written by hand.
class Bytes {
 public:
  template <class Number>
  Bytes& put(Number number) {
    while ((bytes_.size() - 4) % sizeof number != 0) bytes_.push_back(std::byte{0});
    const auto* const begin = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), begin, begin + sizeof number);
    return *this;
  }
  Bytes& put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    for (const char letter : text) bytes_.push_back(std::byte(letter));
    bytes_.push_back(std::byte{0});
    return *this;
  }
  const std::vector<std::byte>& all() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
};

/// scene/inputs of version 9 with events: kind, verb, argument, bound.
std::vector<std::byte> old_inputs(
    const std::vector<std::tuple<std::uint32_t, std::uint8_t, std::string, std::uint8_t>>& events) {
  using U32 = std::uint32_t;
  using U64 = std::uint64_t;
  Bytes bytes;
  bytes.put(U64{77}).put(U64{3}).put(U32{msg::PACE_LOCKSTEP}).put(std::uint8_t{1});
  bytes.put(std::string("0.1")).put(U32{8}).put(U64{1000}).put(U64{0});
  bytes.put(U32{0}).put(U32{0}).put(U32{1});  // scenes, bounds of devices, samples
  bytes.put(U64{11}).put(U64{600}).put(U32{5}).put(std::uint8_t{1}).put(std::uint8_t{1});
  for (int i = 0; i < 4; ++i) bytes.put(U64{9});
  bytes.put(std::int64_t{-2}).put(U32{1}).put(0.5).put(U32{1}).put(0.25);
  bytes.put(static_cast<U32>(events.size()));
  U64 number = 20;
  for (const auto& [kind, verb, argument, bound] : events) {
    bytes.put(number++).put(U64{601}).put(U64{2404}).put(kind).put(U32{5});
    bytes.put(verb).put(argument).put(bound);
  }
  return bytes.all();
}

TEST(Payload, OfInputsOfWireVersion9IsReadAsOneOfToday) {
  const std::vector<std::byte> payload = old_inputs({{0, msg::VERB_PAUSE, "", 0},
                                                     {0, msg::VERB_RESUME, "", 0},
                                                     {0, msg::VERB_STEP, "6", 0},
                                                     {0, msg::VERB_RESET, "", 0},
                                                     {0, msg::VERB_SET, "spring.stiffness=2", 0},
                                                     {0, msg::VERB_STATE, "bow glides", 0},
                                                     {1, 0, "", 0},
                                                     {2, 0, "", 0},
                                                     {3, 0, "", 2}});
  msg::SceneInputs read;
  read.event().resize(3);  // what a message had before
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read.wire_version(), 9U);
  EXPECT_EQ(read.epoch(), 77U);
  EXPECT_EQ(read.batch(), 3U);
  EXPECT_EQ(read.clock(), msg::PACE_LOCKSTEP);
  EXPECT_TRUE(read.keeps_devices());
  EXPECT_EQ(read.engine_version(), "0.1");
  EXPECT_EQ(read.hash_version(), 8U);
  EXPECT_EQ(read.turns(), 1000U);
  ASSERT_EQ(read.sample().size(), 1U);
  EXPECT_EQ(read.sample()[0].time_nsec(), -2);
  EXPECT_EQ(read.sample()[0].value(), std::vector<double>{0.25});
  std::vector<msg::InputKind> kinds;
  for (const msg::InputEvent& event : read.event()) kinds.push_back(event.kind());
  EXPECT_EQ(kinds,
            (std::vector<msg::InputKind>{msg::INPUT_PAUSE, msg::INPUT_RESUME, msg::INPUT_STEP,
                                         msg::INPUT_RESET, msg::INPUT_SET, msg::INPUT_STATE,
                                         msg::INPUT_HOLD, msg::INPUT_REPEAT, msg::INPUT_LET_GO}));
  EXPECT_EQ(read.event()[4].argument(), "spring.stiffness=2");
  EXPECT_EQ(read.event()[8].bound(), msg::BOUND_NUMBER);
  EXPECT_EQ(read.event()[8].number(), 28U);
  EXPECT_EQ(read.event()[8].step(), 2404U);

  EXPECT_EQ(encode_old_inputs(read), payload);
  msg::SceneInputs again;
  ASSERT_TRUE(decode(encode(read), again));
  EXPECT_EQ(again.event(), read.event());
  for (std::size_t size = 0; size < payload.size(); ++size)
    EXPECT_FALSE(decode(std::span(payload).first(size), again)) << "cut at " << size;
}

TEST(Payload, OfInputsHasTheWireVersionInTheOrderOfItsBytes) {
  std::vector<std::byte> payload(24, std::byte{0});
  const auto is_old = [&](int order, std::uint8_t first, std::uint8_t last) {
    payload[1] = std::byte(order);
    payload[20] = std::byte{first};
    payload[23] = std::byte{last};
    return is_old_inputs(payload);
  };
  EXPECT_TRUE(is_old(1, 2, 0)) << "little-endian: a clock";
  EXPECT_FALSE(is_old(1, 10, 0)) << "a version";
  EXPECT_FALSE(is_old(1, 0, 2));
  EXPECT_TRUE(is_old(0, 0, 2)) << "big-endian: a clock";
  EXPECT_FALSE(is_old(0, 0, 10)) << "a version";
  EXPECT_FALSE(is_old(0, 2, 0));
  EXPECT_FALSE(is_old_inputs(std::span(payload).first(23)));
}

TEST(Payload, OfInputsOfWireVersion9WithAnEventThatIsNoneIsRefused) {
  msg::SceneInputs read;
  EXPECT_FALSE(decode(old_inputs({{4, 0, "", 0}}), read)) << "kind";
  EXPECT_FALSE(decode(old_inputs({{0, msg::VERB_LOAD, "", 0}}), read));
  EXPECT_FALSE(decode(old_inputs({{0, msg::VERB_GET, "", 0}}), read));
  EXPECT_FALSE(decode(old_inputs({{3, 0, "", 4}}), read)) << "bound";
}

TEST(Payload, OfAFrameHasItsBondsAndTheForcesOnItsPorts) {
  msg::SceneFrame frame;
  frame.position_m({1.0F, 2.0F, 3.0F});
  frame.link_state({1, 129, 0});
  frame.bond_ends({0, 1, 1, 70000});
  frame.bond_state({1, 130});
  frame.bond_count({0, 2});
  frame.bonds_left_out(5);
  frame.port_force_n({0.0F, -0.25F, 0.0F});
  std::vector<std::byte> payload = encode(frame);
  msg::SceneFrame read;
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read, frame);

  payload.resize(payload.size() - 4);
  EXPECT_FALSE(decode(payload, read)) << "cut short";
}

TEST(Payload, OfAFrameOfWireVersion8IsReadWithoutBonds) {
  msg::SceneFrame frame;
  frame.position_m({1.0F, 2.0F, 3.0F});
  frame.link_state({1, 129});
  frame.position_hash(7);
  std::vector<std::byte> payload = encode(frame);
  payload.resize(payload.size() - 20);  // four counts and bonds_left_out
  msg::SceneFrame read;
  ASSERT_TRUE(decode(payload, read));
  EXPECT_EQ(read, frame);

  payload.pop_back();
  EXPECT_FALSE(decode(payload, read)) << "cut short";
}

/// A reader with an Arrival takes samples out of DDS in the thread that receives them: one of DDS, or
/// the thread that waits.
class ArrivalAt : public testing::TestWithParam<bool> {
 protected:
  static ParticipantConfig loop(const std::string& session, bool lockstep = false) {
    ParticipantConfig config = member(session + (GetParam() ? "_loop" : ""), "sim", lockstep);
    config.for_loop = GetParam();
    return config;
  }
  static ParticipantConfig other(const std::string& session, const std::string& node,
                                 bool lockstep = false) {
    return member(session + (GetParam() ? "_loop" : ""), node, lockstep);
  }
};

TEST_P(ArrivalAt, CountsTheMessagesOfItsReadersAndWakesWhoWaits) {
  Participant device(other("arrival", "keyboard"));
  Participant sim(loop("arrival"));
  Arrival arrival;
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions, &arrival);
  Reader<msg::GestureForces> other(sim, Topic::kForces, &arrival);
  Writer<msg::GesturePositions> positions(device, Topic::kPositions);
  Writer<msg::GestureForces> forces(device, Topic::kForces);
  ASSERT_TRUE(eventually([&] {
    return reader.matched_count() == 1 && other.matched_count() == 1 &&
           positions.matched_count() == 1 && forces.matched_count() == 1;
  }));
  const auto waits = [&arrival](std::uint32_t seen) {
    const std::int64_t patience = 10'000'000'000;
    return arrival.wait_until(seen, node::monotonic_nsec() + patience);
  };

  std::uint32_t seen = arrival.count();
  msg::GesturePositions sample = sample_of(5, 7);
  ASSERT_TRUE(positions.write(sample));
  ASSERT_TRUE(waits(seen));
  msg::GesturePositions taken;
  ASSERT_TRUE(reader.take(taken));
  EXPECT_EQ(taken.sample(), 7u);
  EXPECT_FALSE(reader.take(taken));

  seen = arrival.count();
  msg::GestureForces force;
  force.device_id(5);
  std::thread late([&] {
    std::this_thread::sleep_for(20ms);
    EXPECT_TRUE(forces.write(force));
  });
  EXPECT_TRUE(waits(seen)) << "it waits for both";
  late.join();
  EXPECT_TRUE(other.take(force));

  EXPECT_FALSE(arrival.wait_until(arrival.count(), node::monotonic_nsec() + 1'000'000));
}

TEST_P(ArrivalAt, KeepsTheNewestOfEachDeviceAndWriterWhateverAnotherSends) {
  Participant device(other("room", "keyboard"));
  Participant third(other("room", "flood"));
  Participant sim(loop("room"));
  Arrival arrival;
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions, &arrival);
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);
  Writer<msg::GesturePositions> flood(third, Topic::kPositions);
  Writer<msg::GesturePositions> own(sim, Topic::kPositions);
  ASSERT_TRUE(eventually([&] {
    return reader.matched_count() == 3 && writer.matched_count() == 1 && flood.matched_count() == 1;
  }));
  const auto write = [&](Writer<msg::GesturePositions>& by, std::uint32_t id, std::uint64_t n) {
    const std::uint32_t seen = arrival.count();
    msg::GesturePositions sample = sample_of(id, n);
    ASSERT_TRUE(by.write(sample));
    arrival.wait_until(seen, node::monotonic_nsec() + 100'000'000);  // best effort: one may be lost
  };
  // Each of them three times: the last of three that are lost would be more than a busy machine.
  for (std::uint64_t number = 1; number <= 3; ++number) write(writer, 5, number);
  for (std::uint64_t number = 1; number <= 3; ++number) write(writer, 6, number);
  for (std::uint64_t number = 1; number <= 300; ++number) write(flood, 5, number);
  write(own, 5, 1);

  std::vector<std::pair<std::uint32_t, std::uint64_t>> taken;
  for (msg::GesturePositions sample; reader.take(sample);)
    taken.emplace_back(sample.device_id(), sample.sample());
  ASSERT_EQ(taken.size(), 3u) << "one of each device and writer, and none of its own";
  EXPECT_EQ(taken[0].first, 5u);
  EXPECT_LE(taken[0].second, 3u);
  EXPECT_EQ(taken[1].first, 6u);
  EXPECT_EQ(taken[2].first, 5u);
  EXPECT_GT(taken[2].second, 290u);
}

/// In lockstep every message counts, with an arrival as without one.
TEST_P(ArrivalAt, LosesNothingInLockstep) {
  Participant device(other("letters", "keyboard", true));
  Participant sim(loop("letters", true));
  Arrival arrival;
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions, &arrival);
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);
  ASSERT_TRUE(
      eventually([&] { return reader.matched_count() == 1 && writer.matched_count() == 1; }));
  constexpr std::uint32_t kDevices = 60;
  for (std::uint64_t number = 1; number <= 2; ++number) {
    for (std::uint32_t id = 1; id <= kDevices; ++id) {
      msg::GesturePositions sample = sample_of(id, number);
      ASSERT_TRUE(writer.write(sample));
    }
  }

  std::vector<std::uint64_t> newest(kDevices + 1, 0);
  std::uint32_t count = 0;
  EXPECT_TRUE(eventually([&] {
    for (msg::GesturePositions sample; reader.take(sample); ++count)
      EXPECT_EQ(sample.sample(), ++newest.at(sample.device_id()));
    return count == 2 * kDevices;
  })) << count;
}

INSTANTIATE_TEST_SUITE_P(ThreadOf, ArrivalAt, testing::Values(false, true),
                         [](const auto& tested) { return tested.param ? "Loop" : "Dds"; });

/// A loop that computes for long, or has ended, leaves no sample in the socket.
TEST(ForceLoop, SamplesArriveWhileNoThreadWaitsForThem) {
  ParticipantConfig config = member("unattended", "sim");
  config.for_loop = true;
  Participant sim(config);
  Participant device(member("unattended", "keyboard"));
  Arrival arrival;
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions, &arrival);
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);
  ASSERT_TRUE(
      eventually([&] { return reader.matched_count() == 1 && writer.matched_count() == 1; }));
  msg::GesturePositions taken;
  const auto write_and_take = [&](std::uint64_t number) {
    msg::GesturePositions sample = sample_of(5, number);
    return eventually([&] {
      EXPECT_TRUE(writer.write(sample));
      while (reader.take(taken)) {
        if (taken.sample() == number) return true;
      }
      return false;
    });
  };
  EXPECT_TRUE(write_and_take(1)) << "no thread has waited yet";
  arrival.wait_until(arrival.count(), node::monotonic_nsec() + 30'000'000);
  EXPECT_TRUE(write_and_take(2)) << "a thread has waited, and does not come back";
}

TEST(Dds, CarriesALockstepGestureWholeAndInOrder) {
  Participant device(member("gesture", "keyboard", true));
  Participant sim(member("gesture", "sim", true));
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  ASSERT_TRUE(
      eventually([&] { return writer.matched_count() == 1 && reader.matched_count() == 1; }));

  for (std::uint64_t number = 1; number <= 200; ++number) {
    msg::GesturePositions sent = sample_of(5, number);
    ASSERT_TRUE(writer.write(sent));
    msg::GesturePositions received;
    ASSERT_TRUE(receive(reader, received)) << "sample " << number;
    ASSERT_TRUE(received == sent);
  }
}

TEST(Dds, KeepsTheNewestSampleOfEachDeviceForASlowReader) {
  Participant device(member("newest", "keyboard"));
  Participant sim(member("newest", "sim"));
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  ASSERT_TRUE(
      eventually([&] { return writer.matched_count() == 1 && reader.matched_count() == 1; }));

  msg::GesturePositions received;
  std::uint64_t newest_of_1 = 0;
  std::uint64_t newest_of_2 = 0;
  std::uint64_t number = 0;
  // Best effort may lose a sample, so samples go on until the newest of both devices has been seen
  // to advance.
  ASSERT_TRUE(eventually([&] {
    for (int i = 0; i < 10; ++i) {
      ++number;
      msg::GesturePositions first = sample_of(1, number);
      msg::GesturePositions second = sample_of(2, number);
      EXPECT_TRUE(writer.write(first));
      EXPECT_TRUE(writer.write(second));
    }
    while (reader.take(received)) {
      std::uint64_t& newest = received.device_id() == 1 ? newest_of_1 : newest_of_2;
      EXPECT_GT(received.sample(), newest);
      newest = received.sample();
    }
    return newest_of_1 > 20 && newest_of_2 > 20;
  }));
}

TEST(Dds, SessionsInOneDomainDoNotHearEachOther) {
  Participant here(member("here", "sim"));
  Participant there(member("there", "sim"));
  Writer<msg::SceneDescription> writer_here(here, Topic::kDescription);
  Writer<msg::SceneDescription> writer_there(there, Topic::kDescription);
  Participant viewer(member("there", "view"));
  msg::SceneDescription description;
  description.name("of here");
  EXPECT_TRUE(writer_here.write(description));
  description.name("of there");
  EXPECT_TRUE(writer_there.write(description));
  Reader<msg::SceneDescription> reader(viewer, Topic::kDescription);

  msg::SceneDescription received;
  ASSERT_TRUE(receive(reader, received));

  EXPECT_EQ(received.name(), "of there");
  EXPECT_EQ(reader.matched_count(), 1);
  EXPECT_FALSE(reader.take(received));
}

TEST(Dds, KeepsTheDescriptionForLateJoiners) {
  Participant sim(member("late", "sim"));
  Writer<msg::SceneDescription> writer(sim, Topic::kDescription);
  msg::SceneDescription description;
  description.name("string");
  description.link_ends({0, 1, 1, 2});
  EXPECT_TRUE(writer.write(description));

  Participant viewer(member("late", "view"));
  Reader<msg::SceneDescription> reader(viewer, Topic::kDescription);
  msg::SceneDescription received;
  ASSERT_TRUE(receive(reader, received));

  EXPECT_TRUE(received == description);
}

TEST(Dds, CarriesAFrameOfAHundredThousandMats) {
  Participant sim(member("large", "sim"));
  Participant viewer(member("large", "view"));
  Writer<msg::SceneFrame> writer(sim, Topic::kFrame);
  Reader<msg::SceneFrame> reader(viewer, Topic::kFrame);
  ASSERT_TRUE(
      eventually([&] { return writer.matched_count() == 1 && reader.matched_count() == 1; }));
  msg::SceneFrame frame;
  frame.frame(1);
  frame.position_m(std::vector<float>(300'000, 0.25f));

  ASSERT_TRUE(writer.write(frame));

  msg::SceneFrame received;
  ASSERT_TRUE(receive(reader, received));
  EXPECT_TRUE(received == frame);
}

TEST(Dds, AReaderThatAsksForNoRepairReadsAReliableTopicAndAcknowledgesNothing) {
  Participant sim(member("unrepaired", "sim"));
  Participant viewer(member("unrepaired", "view"));
  Writer<msg::SceneFrame> writer(sim, Topic::kFrame);
  Reader<msg::SceneFrame> looks(viewer, Topic::kFrame, nullptr, Repair::kNone);
  ASSERT_TRUE(
      eventually([&] { return writer.matched_count() == 1 && looks.matched_count() == 1; }));
  msg::SceneFrame frame;
  frame.position_m(std::vector<float>(30'000, 0.25f));
  msg::SceneFrame received;
  ASSERT_TRUE(eventually([&] {
    frame.frame(frame.frame() + 1);
    return writer.write(frame) && looks.wait(100ms) && looks.take(received);
  }));
  EXPECT_EQ(received.position_m(), frame.position_m());
  // No reader is waited for, though none acknowledged.
  EXPECT_TRUE(writer.wait_until_acknowledged(0ms));

  // A reader of the same topic that has all repaired is waited for until it has acknowledged.
  Reader<msg::SceneFrame> keeps(viewer, Topic::kFrame);
  ASSERT_TRUE(
      eventually([&] { return writer.matched_count() == 2 && keeps.matched_count() == 1; }));
  ASSERT_TRUE(writer.write(frame));
  EXPECT_TRUE(writer.wait_until_acknowledged(kPatience));
  ASSERT_TRUE(receive(keeps, received));
  EXPECT_TRUE(received == frame);
}

TEST(Dds, WaitingEndsWhenInterrupted) {
  Participant sim(member("interrupt", "sim"));
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  std::thread waker([&] { reader.interrupt(); });
  EXPECT_FALSE(reader.wait(60s));
  waker.join();
}

TEST(Dds, RefusesADomainOutOfRange) {
  EXPECT_THROW(Participant({102, "s", "n", false}), std::runtime_error);
  EXPECT_THROW(Participant({-1, "s", "n", false}), std::runtime_error);
}

TEST(Roster, KnowsWhoIsAliveByWhatItSays) {
  Participant here(member("roster", "here"));
  Participant there(member("roster", "there"));
  Writer<msg::NodeStatus> statuses(there, Topic::kStatus);
  node::Roster roster(here, kPatience);
  node::Roster forgetful(here, 0ms);
  msg::NodeStatus status;
  status.node("sim");
  status.kind(msg::KIND_SIM_NODE);
  status.phase(msg::PHASE_RUNNING);
  EXPECT_TRUE(statuses.write(status));

  EXPECT_TRUE(eventually([&] {
    roster.update();
    return roster.name_of(msg::KIND_SIM_NODE) == "'sim'";
  }));
  EXPECT_EQ(roster.name_of(msg::KIND_DEVICE_NODE), "");
  msg::NodeStatus taken;
  Reader<msg::NodeStatus> reader(here, Topic::kStatus);
  ASSERT_TRUE(receive(reader, taken));
  forgetful.update();
  EXPECT_TRUE(forgetful.alive().empty()) << "matched, and silent since";

  status.phase(msg::PHASE_STOPPED);
  EXPECT_TRUE(statuses.write(status));
  EXPECT_TRUE(eventually([&] {
    roster.update();
    return roster.alive().empty();
  }));
}

TEST(StatusPublisher, ReportsItsNodeAtOnceRegularlyAndOnceMoreAtTheEnd) {
  Participant viewer(member("status", "view"));
  Reader<msg::NodeStatus> reader(viewer, Topic::kStatus);
  Participant sim(member("status", "sim"));
  std::optional<node::StatusPublisher> publisher;
  std::atomic<msg::NodePhase> phase = msg::PHASE_RUNNING;
  publisher.emplace(sim, msg::KIND_SIM_NODE, 77, [&phase](msg::NodeStatus& status) {
    status.phase(phase.load());
    status.ticks(status.ticks() + 500);
  });

  msg::NodeStatus status;
  ASSERT_TRUE(receive(reader, status));
  EXPECT_EQ(status.node(), "sim");
  EXPECT_EQ(status.kind(), msg::KIND_SIM_NODE);
  EXPECT_EQ(status.wire_version(), msg::WIRE_VERSION);
  EXPECT_EQ(status.epoch(), 77u);
  EXPECT_EQ(status.phase(), msg::PHASE_RUNNING);
  EXPECT_GT(status.memory_bytes(), 1e6);
  const std::uint64_t first = status.sequence_number();
  ASSERT_TRUE(receive(reader, status));
  EXPECT_GT(status.sequence_number(), first);
  EXPECT_GT(status.reached_rate_hz(), 0.0);

  phase = msg::PHASE_STOPPED;
  publisher.reset();

  ASSERT_TRUE(
      eventually([&] { return reader.take(status) && status.phase() == msg::PHASE_STOPPED; }));
}

TEST(StatusPublisher, WatchesBetweenTwoMessages) {
  Participant viewer(member("status watch", "view"));
  Reader<msg::NodeStatus> reader(viewer, Topic::kStatus);
  Participant sim(member("status watch", "sim"));
  std::atomic<std::uint64_t> watches = 0;
  const node::StatusPublisher publisher(
      sim, msg::KIND_SIM_NODE, 77, [&](msg::NodeStatus& status) { status.ticks(watches.load()); },
      [&] { ++watches; });

  // Some come before each message, and messages still come.
  msg::NodeStatus status;
  ASSERT_TRUE(eventually([&] { return reader.take(status) && status.ticks() > 2; }));
  const std::uint64_t seen = status.ticks();
  ASSERT_TRUE(eventually([&] { return reader.take(status) && status.ticks() > seen; }));
}

TEST(Dds, SaysThatAProcessWasStartedWithAnotherLaunchFile) {
  ParticipantConfig with_standbys = member("mismatch", "sim");
  with_standbys.standbys = true;
  Participant sim(with_standbys);
  Participant device(member("mismatch", "keyboard"));
  Participant neighbour(member("another session", "keyboard"));
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  Writer<msg::GesturePositions> elsewhere(neighbour, Topic::kPositions);
  std::optional<Writer<msg::GesturePositions>> writer(std::in_place, device, Topic::kPositions);

  EXPECT_TRUE(eventually([&] { return !sim.mismatch().empty() && !device.mismatch().empty(); }));
  EXPECT_NE(sim.mismatch().find("names no hot standby"), std::string::npos) << sim.mismatch();
  EXPECT_NE(device.mismatch().find("names a hot standby"), std::string::npos) << device.mismatch();
  EXPECT_EQ(neighbour.mismatch(), "");
  with_standbys.node = "cordis 1";
  const Participant onlooker(with_standbys);
  ASSERT_TRUE(eventually([&] { return onlooker.writers().size() == 1; }));
  EXPECT_EQ(onlooker.mismatch(), "") << "it reads no positions: this is no reason for its silence";

  const node::StatusPublisher publisher(sim, msg::KIND_SIM_NODE, 77, [](msg::NodeStatus&) {});
  Reader<msg::NodeStatus> reports(device, Topic::kStatus);
  msg::NodeStatus status;
  ASSERT_TRUE(receive(reports, status));
  EXPECT_EQ(status.text(), sim.mismatch());

  writer.reset();  // it has gone
  EXPECT_TRUE(eventually([&] { return sim.mismatch().empty(); }));
}

TEST(Dds, SaysThatAProcessHasAnotherClock) {
  Participant sim(member("clocks", "sim", true));
  Participant device(member("clocks", "keyboard"));
  Participant other(member("clocks", "pedal", true));
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  Writer<msg::GesturePositions> best_effort(device, Topic::kPositions);
  Writer<msg::GesturePositions> reliable(other, Topic::kPositions);

  EXPECT_TRUE(eventually([&] { return !sim.mismatch().empty(); }));
  EXPECT_NE(sim.mismatch().find("another clock"), std::string::npos) << sim.mismatch();
  EXPECT_TRUE(eventually([&] { return reliable.matched_count() == 1; })) << "the same clock";
}

TEST(Dds, SaysThatAProcessHasAnotherClockWhoseQualityOfServiceIsTheSame) {
  ParticipantConfig of_sim = member("paces", "sim");
  of_sim.clock = "asap";
  ParticipantConfig of_device = member("paces", "keyboard");
  of_device.clock = "realtime";
  Participant sim(of_sim);
  Participant device(of_device);
  Participant without(member("paces", "tool"));
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  Writer<msg::GesturePositions> of_tool(without, Topic::kPositions);
  ASSERT_TRUE(eventually([&] { return of_tool.matched_count() == 1; }));
  EXPECT_EQ(sim.mismatch(), "") << "it has no clock";
  Writer<msg::GesturePositions> writer(device, Topic::kPositions);

  for (Participant* one : {&sim, &device}) {
    EXPECT_TRUE(eventually([&] { return !one->mismatch().empty(); }));
    EXPECT_NE(one->mismatch().find("has another clock than that of this node"), std::string::npos)
        << one->mismatch();
  }
}

TEST(StatusPublisher, HasSentAStatusOfNowWhenItHasWaited) {
  Participant viewer(member("status sent", "view"));
  Reader<msg::NodeStatus> reader(viewer, Topic::kStatus);
  Participant sim(member("status sent", "sim"));
  std::atomic<std::uint64_t> ticks = 0;
  std::atomic<std::uint64_t> filled = 0;
  node::StatusPublisher publisher(sim, msg::KIND_SIM_NODE, 77, [&](msg::NodeStatus& status) {
    status.ticks(ticks.load());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    filled = status.ticks();
  });
  msg::NodeStatus status;
  ASSERT_TRUE(receive(reader, status));
  for (std::uint64_t now = 1; now <= 50; ++now) {
    ticks = now;
    publisher.publish_and_wait();
    EXPECT_EQ(filled.load(), now);
  }
  EXPECT_TRUE(eventually([&] { return reader.take(status) && status.ticks() == 50; }));
}

TEST(Dds, ReadsNothingOfAnotherVersionOfTheWireAndNamesBoth) {
  ParticipantConfig newer = member("versions", "keyboard");
  newer.wire_version = msg::WIRE_VERSION + 6;
  Participant sim(member("versions", "sim"));
  Participant pedal(member("versions", "pedal"));
  auto keyboard = std::make_unique<Participant>(newer);
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  Writer<msg::GesturePositions> same(pedal, Topic::kPositions);
  auto other = std::make_unique<Writer<msg::GesturePositions>>(*keyboard, Topic::kPositions);
  ASSERT_TRUE(eventually([&] { return same.matched_count() == 1 && other->matched_count() == 1; }));

  msg::GesturePositions received;
  std::uint64_t number = 0;
  EXPECT_TRUE(eventually([&] {
    msg::GesturePositions of_other = sample_of(1, ++number);
    msg::GesturePositions of_same = sample_of(2, number);
    EXPECT_TRUE(other->write(of_other));
    EXPECT_TRUE(same.write(of_same));
    while (reader.take(received)) EXPECT_EQ(received.device_id(), 2u) << "sample " << number;
    return received.sample() > 100;
  }));
  const std::string refusal =
      "'versions/keyboard' speaks version " + std::to_string(newer.wire_version) +
      " of the wire and this process version " + std::to_string(msg::WIRE_VERSION) +
      ": its messages are refused, and no force flows; start all nodes of a session from the same "
      "Cordis";
  EXPECT_EQ(sim.mismatch(), refusal);

  const node::StatusPublisher publisher(sim, msg::KIND_SIM_NODE, 77, [](msg::NodeStatus&) {});
  Reader<msg::NodeStatus> reports(pedal, Topic::kStatus);
  msg::NodeStatus status;
  ASSERT_TRUE(receive(reports, status));
  EXPECT_EQ(status.text(), refusal);

  other.reset();
  keyboard.reset();
  EXPECT_TRUE(eventually([&] { return sim.mismatch().empty(); })) << sim.mismatch();
}

TEST(WireVersion, OfAProcessStandsInItsUserData) {
  const std::string before = "process 1b2c 4026531836 4711 99";
  EXPECT_EQ(marked_wire_version(before + wire_version_mark(12)), 12u);
  EXPECT_EQ(marked_wire_version(before), 0u) << "older than all versions";
  EXPECT_EQ(marked_wire_version(before + " wire x"), 0u);
  EXPECT_EQ(marked_wire_version(""), std::nullopt) << "another program";
}

TEST(Clock, OfAProcessStandsInItsUserData) {
  const std::string before = "process 1b2c 4026531836 4711 99";
  EXPECT_EQ(marked_clock(before + clock_mark("asap") + wire_version_mark(12)), "asap");
  EXPECT_EQ(marked_wire_version(before + clock_mark("asap") + wire_version_mark(12)), 12u);
  EXPECT_EQ(marked_clock(before + clock_mark("") + wire_version_mark(12)), "");
  EXPECT_EQ(marked_clock("another program clock asap"), "");
}

/// A take of inputs has scenes with their files: the largest has 5 MB, and 256 messages are kept.
TEST(Writer, OfInputsReservesNoRoomForTheLargest) {
  Participant sim({test::own_domain(), "inputs", "sim"});
  const std::size_t before = mallinfo2().hblkhd;
  const Writer<msg::SceneInputs> inputs(sim, Topic::kInputs);
  EXPECT_LT(mallinfo2().hblkhd, before + (std::size_t{64} << 20));
}

TEST(Writer, SaysThatDdsDidNotTakeAMessage) {
  Participant sim(member("unwritten", "sim"));
  Writer<msg::GestureForces> writer(sim, Topic::kForces);
  msg::GestureForces forces;
  for (std::uint32_t device = 0; device < 64; ++device) {
    forces.device_id(device);
    ASSERT_TRUE(writer.write(forces)) << device;
  }
  forces.device_id(64);
  EXPECT_FALSE(writer.write(forces)) << "a writer has room for 64 devices";
}

}  // namespace
}  // namespace cordis::dds
