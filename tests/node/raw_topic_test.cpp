// tests/node/raw_topic_test.cpp -- topics of any type, read and written as bytes.
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "node/dds/raw_reader.h"
#include "node/dds/raw_writer.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/topic_follower.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

using test::eventually;

/// What a RawReader gave, with copies of the messages.
class Received {
 public:
  struct Copy {
    std::vector<std::uint8_t> message;
    std::uint64_t sequence = 0;
    WriterId writer{};
    std::uint64_t missing = 0;
  };
  std::function<void(const RawSample&)> sink() {
    return [this](const RawSample& sample) {
      const std::lock_guard lock(mutex_);
      copies_.push_back({{sample.data, sample.data + sample.size},
                         sample.sequence,
                         sample.writer,
                         sample.missing});
    };
  }
  std::vector<Copy> copies() const {
    const std::lock_guard lock(mutex_);
    return copies_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Copy> copies_;
};

FoundWriter writer_of(const Participant& participant, const std::string& topic) {
  FoundWriter found;
  EXPECT_TRUE(eventually([&] {
    for (const FoundWriter& writer : participant.writers()) {
      if (writer.topic.name == topic) found = writer;
    }
    return !found.topic.name.empty();
  })) << topic;
  return found;
}

msg::GesturePositions positions_of(std::uint32_t device, std::uint64_t sample) {
  msg::GesturePositions positions;
  positions.device_id(device);
  positions.sample(sample);
  positions.axis_count(2);
  positions.position_m()[1] = -0.0125;
  return positions;
}

/// A loop sends its samples to who plays with it at once, and to who observes it from another thread.
TEST(RawTopic, AnObserverOfALoopReceivesEverySampleInOrder) {
  ParticipantConfig of_loop{test::own_domain(), "observed", "hand"};
  of_loop.for_loop = true;
  ParticipantConfig of_observer{test::own_domain(), "observed", "recorder"};
  of_observer.observes = true;
  Participant hand(of_loop);
  Participant observer(of_observer);
  Participant sim({test::own_domain(), "observed", "sim"});
  Writer<msg::GesturePositions> writer(hand, Topic::kPositions);
  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  Received received;
  const RawReader raw(observer, writer_of(observer, "gesture/positions").topic, received.sink());
  ASSERT_TRUE(eventually([&] { return writer.matched_count() == 2; }));

  // Few enough for the socket of a receiver that does not run.
  constexpr std::uint64_t kSent = 1000;
  for (std::uint64_t number = 1; number <= kSent; ++number) {
    msg::GesturePositions sample = positions_of(7, number);
    EXPECT_TRUE(writer.write(sample));
    if (number % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }

  EXPECT_TRUE(eventually([&] { return received.copies().size() >= kSent; }));
  std::uint64_t before = received.copies().front().sequence - 1;
  for (const Received::Copy& copy : received.copies()) EXPECT_EQ(copy.sequence, ++before);
  msg::GesturePositions newest;
  EXPECT_TRUE(eventually([&] { return reader.take(newest) && newest.sample() == kSent; }));
}

/// Who reads bytes sees a standby as soon as every other reader does.
TEST(RawTopic, AStandbyIsReadWhileTheStrongerWriterIsSilent) {
  Participant hand({test::own_domain(), "standby", "hand", false, true});
  Participant backup({test::own_domain(), "standby", "backup", false, true});
  Participant observer({test::own_domain(), "standby", "recorder"});
  Writer<msg::GesturePositions> strong(hand, Topic::kPositions, 10);
  Writer<msg::GesturePositions> weak(backup, Topic::kPositions);
  const RawTopic topic = writer_of(observer, "gesture/positions").topic;
  EXPECT_EQ(topic.deadline_nsec, 20'000'000);
  Received received;
  const RawReader raw(observer, topic, received.sink());
  ASSERT_TRUE(eventually([&] { return strong.matched_count() == 1 && weak.matched_count() == 1; }));

  msg::GesturePositions of_strong = positions_of(7, 1);
  msg::GesturePositions of_weak = positions_of(7, 2);
  std::vector<Received::Copy> copies;
  const auto comes = [&](Writer<msg::GesturePositions>& writer, msg::GesturePositions& sample) {
    const std::size_t before = received.copies().size();
    return eventually([&] {
      EXPECT_TRUE(writer.write(sample));
      copies = received.copies();
      return copies.size() > before;
    });
  };
  ASSERT_TRUE(comes(strong, of_strong));
  ASSERT_TRUE(comes(weak, of_weak)) << "the stronger one is silent";
  const Received::Copy first_of_weak = copies.back();
  EXPECT_NE(first_of_weak.writer, copies.front().writer);
  EXPECT_EQ(first_of_weak.missing, 0u) << "DDS has kept back those before";
  ASSERT_TRUE(comes(strong, of_strong)) << "it is back";
  EXPECT_EQ(copies.back().writer, copies.front().writer);
  EXPECT_EQ(copies.back().missing, 0u);
}

/// A topic that is not wanted has no reader, so it costs its writer nothing.
TEST(RawTopic, AFollowerReadsATopicWhileItIsWanted) {
  Participant node({test::own_domain(), "followed", "node"});
  Participant observer({test::own_domain(), "followed", "observer"});
  Writer<msg::NodeStatus> writer(node, Topic::kStatus);
  msg::NodeStatus status;
  status.node_id(7);
  ASSERT_TRUE(writer.write(status));
  Received received;
  std::atomic<bool> is_wanted{false};
  std::atomic<int> looks{0};
  node::TopicFollower follower(
      observer, [&](const RawTopic& topic) { return topic.name == "node/status" && is_wanted; },
      [sink = received.sink()](const RawTopic&, const RawSample& sample) { sink(sample); },
      [&](const std::vector<FoundWriter>& writers) { looks += writers.empty() ? 0 : 1; });

  ASSERT_TRUE(eventually([&] { return looks > 3; }));
  EXPECT_EQ(writer.matched_count(), 0);
  for (std::size_t times = 1; times <= 2; ++times) {
    is_wanted = true;
    EXPECT_TRUE(eventually([&] { return received.copies().size() == times; }))
        << "what is kept for late joiners comes to each reader";
    EXPECT_EQ(writer.matched_count(), 1);
    is_wanted = false;
    EXPECT_TRUE(eventually([&] { return writer.matched_count() == 0; }));
  }
}

/// Reads a topic as bytes, writes them into another session, and reads them there with their type.
void goes_through_bytes(bool lockstep, bool standbys) {
  Participant hand({test::own_domain(), "live", "hand", lockstep, standbys});
  Participant recorder({test::own_domain(), "live", "recorder"});
  Participant player({test::own_domain(), "played", "player"});
  Participant sim({test::own_domain(), "played", "sim", lockstep, standbys});
  Writer<msg::GesturePositions> typed(hand, Topic::kPositions);

  const RawTopic topic = writer_of(recorder, "gesture/positions").topic;
  EXPECT_EQ(topic.type, "cordis::msg::GesturePositions");
  EXPECT_TRUE(topic.keyed);
  EXPECT_EQ(topic.reliable, lockstep);
  EXPECT_EQ(topic.exclusive, standbys);
  EXPECT_FALSE(topic.transient_local);

  Received received;
  const RawReader raw(recorder, topic, received.sink());
  ASSERT_TRUE(eventually([&] { return typed.matched_count() == 1; }));
  msg::GesturePositions first = positions_of(7, 1);
  msg::GesturePositions second = positions_of(1'000'000'007, 2);
  // A best-effort message may be lost while the two find each other.
  std::uint64_t written = 0;
  for (msg::GesturePositions* message : {&first, &second}) {
    const std::size_t before = received.copies().size();
    ASSERT_TRUE(eventually([&] {
      if (received.copies().size() > before) return true;
      EXPECT_TRUE(typed.write(*message));
      ++written;
      return false;
    }));
  }
  const std::vector<Received::Copy> copies = received.copies();
  EXPECT_EQ(copies.back().sequence, written);
  EXPECT_EQ(copies.front().writer, copies.back().writer);

  Reader<msg::GesturePositions> reader(sim, Topic::kPositions);
  RawWriter again(player, topic);
  msg::GesturePositions last;
  EXPECT_TRUE(eventually([&] {
    for (const Received::Copy& copy : copies) EXPECT_TRUE(again.write(copy.message));
    while (reader.take(last)) {
      if (last == second) return true;
    }
    return false;
  }));
}

TEST(RawTopic, HandsOnBestEffortMessages) {
  goes_through_bytes(false, false);
}

TEST(RawTopic, HandsOnReliableMessages) {
  goes_through_bytes(true, false);
}

TEST(RawTopic, HandsOnMessagesOfAnExclusiveTopic) {
  goes_through_bytes(false, true);
}

TEST(RawTopic, KeepsTheLastMessageOfEachKeyForLateJoiners) {
  Participant first({test::own_domain(), "kept", "first"});
  Participant player({test::own_domain(), "kept", "player"});
  Writer<msg::NodeStatus> typed(first, Topic::kStatus);
  const RawTopic topic = writer_of(player, "node/status").topic;
  EXPECT_TRUE(topic.transient_local);
  Received received;
  const RawReader raw(player, topic, received.sink());
  for (const std::uint32_t node : {1u, 2u, 2u}) {
    msg::NodeStatus status;
    status.node_id(node);
    const std::size_t before = received.copies().size();
    status.ticks(10 + before);
    ASSERT_TRUE(typed.write(status));
    ASSERT_TRUE(eventually([&] { return received.copies().size() > before; }));
  }

  RawWriter again(player, topic);
  for (const Received::Copy& copy : received.copies()) ASSERT_TRUE(again.write(copy.message));
  Participant late({test::own_domain(), "kept", "late"});
  Reader<msg::NodeStatus> statuses(late, Topic::kStatus);
  std::map<std::uint32_t, std::uint64_t> ticks;
  EXPECT_TRUE(eventually([&] {
    for (msg::NodeStatus status; statuses.take(status);) ticks[status.node_id()] = status.ticks();
    return ticks.size() == 2 && statuses.matched_count() == 2;
  }));
  EXPECT_EQ(ticks[1], 10u);
  EXPECT_EQ(ticks[2], 12u);
}

/// A best-effort reader also receives from reliable writers, which another reader reads.
TEST(RawTopic, ReadsNoMessageTwiceWhereWritersDiffer) {
  Participant reliable({test::own_domain(), "mixed", "reliable", true});
  Participant quick({test::own_domain(), "mixed", "quick", false});
  Participant recorder({test::own_domain(), "mixed", "recorder"});
  Writer<msg::GestureForces> sure(reliable, Topic::kForces);
  Writer<msg::GestureForces> unsure(quick, Topic::kForces);
  ASSERT_TRUE(eventually([&] { return recorder.writers().size() == 2; }));

  Received of_sure;
  Received of_unsure;
  RawTopic topic = recorder.writers()[0].topic;
  topic.reliable = true;
  const RawReader sure_reader(recorder, topic, of_sure.sink());
  topic.reliable = false;
  const RawReader unsure_reader(recorder, topic, of_unsure.sink());
  ASSERT_TRUE(eventually([&] { return sure.matched_count() == 2; }));
  ASSERT_TRUE(eventually([&] { return unsure.matched_count() == 1; }));
  msg::GestureForces forces;
  forces.device_id(1);
  ASSERT_TRUE(sure.write(forces));
  ASSERT_TRUE(eventually([&] { return of_sure.copies().size() == 1; }));
  ASSERT_TRUE(eventually([&] {
    forces.device_id(2);
    EXPECT_TRUE(unsure.write(forces));
    return !of_unsure.copies().empty();
  }));
  EXPECT_EQ(of_sure.copies().size(), 1u);
  for (const Received::Copy& copy : of_unsure.copies()) EXPECT_EQ(copy.message[4], 2u);
}

TEST(RawTopic, OfEveryPartitionAreFoundWhenAskedFor) {
  Participant one({test::own_domain(), "one", "node"});
  Participant two({test::own_domain(), "two", "node"});
  ParticipantConfig everybody{test::own_domain(), "", "all"};
  everybody.every_partition = true;
  Participant all(everybody);
  const Participant third({test::own_domain(), "three", "node"});
  const Writer<msg::NodeStatus> of_one(one, Topic::kStatus);
  const Writer<msg::NodeStatus> of_two(two, Topic::kStatus);
  ASSERT_TRUE(eventually([&] { return all.writers().size() == 2; }));
  EXPECT_TRUE(third.writers().empty());
}

}  // namespace
}  // namespace cordis::dds
