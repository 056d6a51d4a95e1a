// tests/node/participant_test.cpp -- who is there, with processes that stop, die and come back.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/dds/arrival.h"
#include "node/dds/participant_ports.h"
#include "node/dds/process_identity.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/time.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/rounds.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

using namespace std::chrono_literals;

using test::eventually;
using test::kPatience;

ParticipantConfig member(const std::string& session, const std::string& node) {
  return {test::own_domain(), session, node};
}

std::unique_ptr<test::ChildProcess> speaker(const std::string& session, const std::string& node) {
  return std::make_unique<test::ChildProcess>(std::vector<std::string>{
      CORDIS_STATUS_SPEAKER, std::to_string(test::own_domain()), session, node});
}

bool knows(const Participant& participant, const std::string& name) {
  const std::vector<Peer> peers = participant.peers();
  return std::ranges::any_of(peers, [&](const Peer& peer) { return peer.name == name; });
}

Peer peer_named(const Participant& participant, const std::string& name) {
  for (const Peer& peer : participant.peers()) {
    if (peer.name == name) return peer;
  }
  return {};
}

/// Waits for a status with a number above `number`, and sets `number` to the newest.
bool receives_more(Reader<msg::NodeStatus>& statuses, std::uint64_t& number) {
  return eventually([&] {
    msg::NodeStatus status;
    while (statuses.take(status)) {
      if (status.sequence_number() > number) {
        number = status.sequence_number();
        return true;
      }
    }
    return false;
  });
}

TEST(Participant, ForgetsAProcessThatIsKilledAndNoneThatIsStopped) {
  Participant here(member("ends", "here"));
  const Reader<msg::NodeStatus> statuses(here, Topic::kStatus);
  const auto killed = speaker("ends", "killed");
  const auto stopped = speaker("ends", "stopped");
  ASSERT_TRUE(eventually([&] { return statuses.matched_count() == 2; }));

  stopped->signal(SIGSTOP);
  killed->signal(SIGKILL);

  // DDS takes the readers and writers of a participant away first, and the participant afterwards.
  EXPECT_TRUE(
      eventually([&] { return statuses.matched_count() == 1 && !knows(here, "ends/killed"); }));
  EXPECT_TRUE(knows(here, "ends/stopped")) << "it was stopped the whole time";
  stopped->signal(SIGCONT);
}

TEST(Participant, ForgetsAProcessThatIsKilledBeforeItsParentHasWaitedForIt) {
  Participant here(member("zombie", "here"));
  const auto killed = speaker("zombie", "killed");
  ASSERT_TRUE(eventually([&] { return knows(here, "zombie/killed"); }));

  killed->signal(SIGKILL);  // and no process waits for it: it stays a zombie

  EXPECT_TRUE(eventually([&] { return !knows(here, "zombie/killed"); }));
  EXPECT_EQ(killed->wait(kPatience), 128 + SIGKILL);
}

double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time of this process for one message to those who listen [s], of two writers in turn:
/// the least of some means, for other programs disturb both alike.
std::array<double, 2> costs_of_a_message(std::array<Writer<msg::SceneEvents>*, 2> writers) {
  constexpr int kRounds = 100;
  constexpr int kMessages = 1000;
  msg::SceneEvents events;
  std::array<double, 2> min_s{1.0, 1.0};
  for (std::size_t round = 0; round < 2 * kRounds; ++round) {
    const double begin_s = processor_time_s();
    for (int n = 0; n < kMessages; ++n) EXPECT_TRUE(writers[round % 2]->write(events));
    min_s[round % 2] = std::min(min_s[round % 2], (processor_time_s() - begin_s) / kMessages);
  }
  return min_s;
}

/// CORDIS_RESTARTS of the environment are done by hand, for the figure in docs/reliability.md.
TEST(Participant, KeepsNothingOfProcessesThatWereKilledAndStartedAgain) {
  const char* const by_hand = std::getenv("CORDIS_RESTARTS");
  const int restarts = by_hand != nullptr ? std::atoi(by_hand) : test::rounds(30);
  Participant here(member("restarts", "here"));
  const Reader<msg::NodeStatus> statuses(here, Topic::kStatus);
  Writer<msg::SceneEvents> writer(here, Topic::kEvents);
  const auto partner = speaker("restarts", "partner");
  ASSERT_TRUE(eventually([&] {
    return statuses.matched_count() == 1 && writer.matched_count() == 1 && here.peers().size() == 1;
  }));
  const std::size_t writers = here.writers().size();

  for (int n = 0; n < restarts; ++n) {
    const auto node = speaker("restarts", "node");
    ASSERT_TRUE(eventually([&] { return knows(here, "restarts/node"); })) << "start " << n;
    node->signal(SIGKILL);
    ASSERT_EQ(node->wait(kPatience), 128 + SIGKILL);
    if (n % 5 != 4) continue;  // of the others some are killed before the last one is forgotten
    ASSERT_TRUE(eventually([&] { return !knows(here, "restarts/node"); })) << "start " << n;
  }

  EXPECT_TRUE(eventually([&] {
    return here.peers().size() == 1 && here.writers().size() == writers &&
           statuses.matched_count() == 1 && writer.matched_count() == 1;
  })) << here.peers().size()
      << " peers, " << here.writers().size() << " writers";
  EXPECT_TRUE(knows(here, "restarts/partner"));
  Participant joined_now(member("restarts", "joined_now"));
  Writer<msg::SceneEvents> writer_now(joined_now, Topic::kEvents);
  ASSERT_TRUE(eventually([&] { return writer_now.matched_count() == 1; }));
  const auto [cost_s, cost_now_s] = costs_of_a_message({&writer, &writer_now});
  std::printf(
      "processor time of a message after %d restarts: %.3g us, of one who joins now %.3g us\n",
      restarts, 1e6 * cost_s, 1e6 * cost_now_s);
}

TEST(Participant, HearsAndIsHeardByAProcessThatItHasDropped) {
  Participant here(member("returns", "here"));
  Reader<msg::NodeStatus> statuses(here, Topic::kStatus);
  Reader<msg::SceneDescription> scenes(here, Topic::kDescription);
  Writer<msg::SceneDescription> scene(here, Topic::kDescription);
  Writer<msg::GestureForces> forces(here, Topic::kForces);
  Participant there(member("returns", "there"));
  Reader<msg::SceneDescription> scenes_there(there, Topic::kDescription);
  msg::SceneDescription description;
  description.name("said once");
  EXPECT_TRUE(scene.write(description));
  ASSERT_TRUE(eventually([&] { return scenes_there.take(description); }));
  const auto other = speaker("returns", "other");
  std::uint64_t number = 0;
  ASSERT_TRUE(receives_more(statuses, number));

  here.drop(peer_named(here, "returns/other"));

  ASSERT_TRUE(eventually([&] { return here.rejoin_count() > 0; }));
  EXPECT_TRUE(receives_more(statuses, number));
  EXPECT_TRUE(receives_more(statuses, number));
  // Its last message is there for those who have found it again, as it was for those before.
  description.name("");
  EXPECT_TRUE(eventually([&] { return scenes_there.take(description); }));
  EXPECT_EQ(description.name(), "said once");
  EXPECT_EQ(there.rejoin_count(), 0u) << "it has dropped no process that has come back";
}

TEST(Participant, WritesAndReadsWhileItJoinsAnew) {
  Participant here(member("meanwhile", "here"));
  Participant there(member("meanwhile", "there"));
  Writer<msg::GesturePositions> writer(here, Topic::kPositions);
  Reader<msg::GesturePositions> reader(there, Topic::kPositions);
  Writer<msg::GestureForces> answers(there, Topic::kForces);
  Reader<msg::GestureForces> forces(here, Topic::kForces);
  ASSERT_TRUE(eventually([&] { return forces.matched_count() == 1; }));
  std::atomic<bool> ending{false};
  std::atomic<std::uint64_t> exchanges{0};
  std::thread echo([&] {
    msg::GesturePositions sample;
    msg::GestureForces answer;
    while (!ending) {
      if (!reader.take(sample)) {
        reader.wait(1ms);
        continue;
      }
      answer.answered_sample(sample.sample());
      EXPECT_TRUE(answers.write(answer));
    }
  });
  std::thread loop([&] {
    msg::GesturePositions sample;
    msg::GestureForces answer;
    while (!ending) {
      sample.sample(sample.sample() + 1);
      EXPECT_TRUE(writer.write(sample));
      forces.wait(1ms);
      while (forces.take(answer)) ++exchanges;
    }
  });

  for (std::uint64_t time = 1; time <= 5; ++time) {
    const std::uint64_t before = here.rejoin_count();
    ASSERT_TRUE(eventually([&] { return knows(here, "meanwhile/there"); }));
    here.drop(peer_named(here, "meanwhile/there"));
    EXPECT_TRUE(eventually([&] { return here.rejoin_count() > before; }));
    const std::uint64_t reached = exchanges;
    EXPECT_TRUE(eventually([&] { return exchanges > reached + 100; })) << "time " << time;
  }

  ending = true;
  echo.join();
  loop.join();
}

/// Local addresses of the UDP sockets of this process' network, as /proc shows them, by a filter on
/// the port.
std::set<std::string> local_addresses(const std::function<bool(int)>& wanted) {
  std::set<std::string> addresses;
  std::ifstream file("/proc/self/net/udp");
  std::string line;
  std::getline(file, line);  // titles
  while (std::getline(file, line)) {
    const std::size_t colon = line.find(':', line.find(':') + 1);
    if (wanted(std::stoi(line.substr(colon + 1, 4), nullptr, 16))) {
      addresses.insert(line.substr(colon - 8, 8));
    }
  }
  return addresses;
}

TEST(Participant, WaitsOnceForAllItsWritersWhenAProcessHasStoppedReading) {
  Participant here(member("farewell", "here"));
  Writer<msg::NodeStatus> statuses(here, Topic::kStatus);
  Writer<msg::ControlReply> replies(here, Topic::kReply);
  Writer<msg::SceneEvents> events(here, Topic::kEvents);
  const auto stopped = speaker("farewell", "stopped");
  ASSERT_TRUE(eventually([&] {
    return statuses.matched_count() == 1 && replies.matched_count() == 1 &&
           events.matched_count() == 1;
  }));
  stopped->signal(SIGSTOP);
  msg::NodeStatus status;
  msg::ControlReply reply;
  msg::SceneEvents batch;
  ASSERT_TRUE(eventually([&] {
    return replies.write(reply) && !replies.wait_until_acknowledged(20ms);
  })) << "it has stopped";
  ASSERT_TRUE(statuses.write(status) && events.write(batch));

  const auto begun = std::chrono::steady_clock::now();
  statuses.finish();
  const auto first = std::chrono::steady_clock::now() - begun;
  replies.finish();
  events.finish();
  const auto all = std::chrono::steady_clock::now() - begun;

  EXPECT_GT(first, kFarewell / 2) << "it waits for the process that has stopped";
  EXPECT_LT(all, 2 * first) << "the others wait no more";
}

TEST(Participant, ListensOnLoopbackAloneAndToNoMulticast) {
  const Participant here(member("unicast", "here"));

  const int domain = test::own_domain();
  const int first = discovery_port(domain, 0) - 10;  // the multicast ports come first
  const auto of_domain = local_addresses(
      [&](int port) { return first <= port && port < discovery_port(domain + 1, 0) - 10; });

  EXPECT_EQ(of_domain, std::set<std::string>{"0100007F"}) << "127.0.0.1, and no group";
}

TEST(Participant, SaysThatADomainIsFull) {
  std::vector<std::unique_ptr<ParticipantPorts>> others;
  for (int i = 0; i < kMaxParticipants; ++i) {
    others.push_back(std::make_unique<ParticipantPorts>(test::own_domain(), "127.0.0.1"));
  }

  try {
    const Participant one_too_many(member("full", "here"));
    FAIL() << "it found a place";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("is full: all 64 pairs of UDP ports"),
              std::string::npos)
        << error.what();
  }
  others.pop_back();
  EXPECT_NO_THROW(Participant(member("full", "here")));
}

TEST(Participant, ThatObservesTakesAPortOfItsOwnWhereThereIsOne) {
  const int domain = test::own_domain();
  std::vector<std::unique_ptr<ParticipantPorts>> observers;
  for (int n = 0; n <= kMaxObservers; ++n) {
    observers.push_back(std::make_unique<ParticipantPorts>(domain, "127.0.0.1", true));
    const bool has_own = n < kMaxObservers;
    EXPECT_EQ(is_of_observer(observers.back()->discovery(), domain, true), has_own) << n;
    EXPECT_EQ(is_of_observer(observers.back()->samples(), domain, true), has_own) << n;
  }
  const ParticipantPorts other(domain, "127.0.0.1");
  EXPECT_FALSE(is_of_observer(other.samples(), domain, true));
  for (const int of_domain : {domain - 1, domain + 1})
    EXPECT_FALSE(is_of_observer(observers.front()->samples(), of_domain, true)) << of_domain;

  std::vector<std::unique_ptr<ParticipantPorts>> others;
  while (others.size() + 2 < kMaxParticipants)
    others.push_back(std::make_unique<ParticipantPorts>(domain, "127.0.0.1"));
  EXPECT_THROW(ParticipantPorts(domain, "127.0.0.1"), std::runtime_error)
      << "those of observers are not for others";
}

TEST(Participant, HasTheSamePortsAtEveryAddressOfLoopback) {
  const int domain = test::own_domain();
  Network second;
  second.address = "127.0.0.2";
  ASSERT_TRUE(second.is_loopback());

  const ParticipantPorts observer(domain, second.address, true);

  EXPECT_TRUE(is_of_observer(observer.discovery(), domain, second.is_loopback()));
}

/// A loop takes its samples itself, out of the socket that its participant has at that moment.
TEST(Participant, ThatALoopWaitsForJoinsAnew) {
  ParticipantConfig config = member("loop_anew", "here");
  config.for_loop = true;
  Participant here(config);
  Participant there(member("loop_anew", "there"));
  Arrival arrival;
  Reader<msg::GestureForces> forces(here, Topic::kForces, &arrival);
  Writer<msg::GestureForces> writer(there, Topic::kForces);
  std::atomic<bool> ending{false};
  std::thread writes([&] {
    msg::GestureForces force;
    while (!ending) {
      force.sample(force.sample() + 1);
      EXPECT_TRUE(writer.write(force));
      std::this_thread::sleep_for(200us);
    }
  });
  const auto receives = [&] {
    msg::GestureForces force;
    int taken = 0;
    return eventually([&] {
      const std::uint32_t seen = arrival.count();
      while (forces.take(force)) ++taken;
      arrival.wait_until(seen, node::monotonic_nsec() + 1'000'000);
      return taken > 100;
    });
  };

  EXPECT_TRUE(receives());
  for (int time = 1; time <= 5; ++time) {
    const std::uint64_t before = here.rejoin_count();
    ASSERT_TRUE(eventually([&] { return knows(here, "loop_anew/there"); }));
    here.drop(peer_named(here, "loop_anew/there"));
    EXPECT_TRUE(eventually([&] {
      arrival.wait_until(arrival.count(), node::monotonic_nsec() + 1'000'000);
      return here.rejoin_count() > before;
    }));
    EXPECT_TRUE(receives()) << "time " << time;
  }
  ending = true;
  writes.join();
}

TEST(Participant, SaysThatAnAddressIsOfThisHostNoMore) {
  ParticipantConfig config = member("gone", "here");
  config.network.address = "203.0.113.9";
  try {
    const Participant elsewhere(config);
    FAIL() << "203.0.113.9 is kept for documents";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("203.0.113.9 is no address of this host any more"),
              std::string::npos)
        << error.what();
  }
}

TEST(ProcessIdentity, IsThatOfALivingProcessOfThisHost) {
  const std::string self = process_identity();

  EXPECT_EQ(state_of(self), ProcessState::kAlive);
  EXPECT_EQ(state_of(self + "0"), ProcessState::kEnded) << "its number was another's before";
  EXPECT_EQ(state_of(""), ProcessState::kUnknown) << "a program that is not of Cordis";
  EXPECT_EQ(state_of("process elsewhere 1 1 1"), ProcessState::kUnknown) << "another host";
  EXPECT_EQ(state_of(self.substr(0, self.rfind(' '))), ProcessState::kUnknown) << "cut off";
}

}  // namespace
}  // namespace cordis::dds
