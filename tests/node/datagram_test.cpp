// tests/node/datagram_test.cpp -- a network that also brings changed copies of what is sent.
//
// CORDIS_DATAGRAMS=1000000 build/release/bin/datagram_test plays so many copies, CORDIS_RANDOM_SEED=2 others.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "idl/gesture.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "tests/support/datagrams.h"
#include "tests/support/eventually.h"
#include "tests/support/foreign_reader.h"
#include "tests/support/rounds.h"
#include "tests/support/test_domain.h"
#include "tests/support/test_seed.h"

namespace {

using cordis::test::Datagram;

long number_of(const char* variable, long otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atol(text);
}

/// The changed copy that this thread has last, for who looks at a crash.
thread_local const Datagram* playing = nullptr;

void keep_playing(int signal) {
  if (playing != nullptr) {
    std::fprintf(stderr, "ends by signal %d after this datagram:", signal);
    for (const std::uint8_t octet : *playing) std::fprintf(stderr, " %02x", octet);
    std::fputc('\n', stderr);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Brings some changed copies of each datagram before it. Nothing is lost.
class BadNetwork {
 public:
  /// So many copies of each, until that many were brought in all.
  void begin(int copies_of_each, long copies, std::uint64_t seed) {
    const std::lock_guard lock(mutex_);
    random_.seed(seed);
    copies_of_each_ = copies_of_each;
    left_ = copies;
  }
  long left() {
    const std::lock_guard lock(mutex_);
    return left_;
  }
  void pause() { set_paused(true); }
  void go_on() { set_paused(false); }

  ssize_t receive(int file, void* data, std::size_t room, int flags, sockaddr* from,
                  socklen_t* from_size) {
    static const auto kReceive =
        reinterpret_cast<decltype(&recvfrom)>(dlsym(RTLD_NEXT, "recvfrom"));
    thread_local Datagram copy;
    {
      const std::lock_guard lock(mutex_);
      if (Waiting* waiting = find(file)) return bring(*waiting, data, room, from, from_size, copy);
    }
    const ssize_t size = kReceive(file, data, room, flags, from, from_size);
    if (size < 20 || std::memcmp(data, "RTPS", 4) != 0) return size;
    const std::lock_guard lock(mutex_);
    if (left_ <= 0 || is_paused_) return size;
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    Waiting waiting{file, copies_of_each_, {bytes, bytes + size}, {}, 0};
    if (from != nullptr) {
      waiting.from_size = std::min<socklen_t>(*from_size, sizeof waiting.from);
      std::memcpy(&waiting.from, from, waiting.from_size);
    }
    waiting_.push_back(std::move(waiting));
    return bring(waiting_.back(), data, room, from, from_size, copy);
  }

 private:
  struct Waiting {
    int file;
    int copies;
    Datagram datagram;
    sockaddr_storage from;
    socklen_t from_size;
  };

  void set_paused(bool is_paused) {
    const std::lock_guard lock(mutex_);
    is_paused_ = is_paused;
  }

  Waiting* find(int file) {
    const auto found = std::ranges::find(waiting_, file, &Waiting::file);
    return found == waiting_.end() ? nullptr : &*found;
  }

  ssize_t bring(Waiting& waiting, void* data, std::size_t room, sockaddr* from,
                socklen_t* from_size, Datagram& copy) {
    if (from != nullptr) {
      std::memcpy(from, &waiting.from, waiting.from_size);
      *from_size = waiting.from_size;
    }
    const bool is_copy = waiting.copies > 0 && left_ > 0 && !is_paused_;
    copy = waiting.datagram;
    if (is_copy) {
      change(copy);
      --waiting.copies;
      --left_;
    } else {
      seen_[seen_count_++ % seen_.size()] = std::move(waiting.datagram);
      waiting_.erase(waiting_.begin() + (&waiting - waiting_.data()));
    }
    playing = is_copy ? &copy : nullptr;
    const std::size_t size = std::min(copy.size(), room);
    std::memcpy(data, copy.data(), size);
    return static_cast<ssize_t>(size);
  }

  std::size_t below(std::size_t bound) {
    return bound == 0 ? 0 : static_cast<std::size_t>(random_() % bound);
  }

  /// Changes bytes and numbers, cuts, lengthens, or goes on as another datagram does. Most changes leave who sends
  /// and what is in a message as they are, for the rest is dropped soon.
  void change(Datagram& datagram) {
    constexpr std::array<std::uint8_t, 6> kEdges{0, 1, 0x7f, 0x80, 0xfe, 0xff};
    for (std::size_t times = 1 + below(3); times > 0; --times) {
      const std::size_t begin = below(16) == 0 ? 0 : 20;
      const std::size_t near = std::min<std::size_t>(datagram.size(), begin + 120);
      const std::size_t end = below(2) == 0 ? near : datagram.size();
      const std::size_t place = begin + below(end > begin ? end - begin : 1);
      if (place >= datagram.size()) continue;
      switch (below(7)) {
        case 0:
          datagram[place] ^= static_cast<std::uint8_t>(1U << below(8));
          break;
        case 1:
          datagram[place] = kEdges[below(kEdges.size())];
          break;
        case 2:
          datagram[place] = static_cast<std::uint8_t>(random_());
          break;
        case 3: {
          const std::size_t aligned = place / 4 * 4;
          const std::uint8_t value = kEdges[below(kEdges.size())];
          for (std::size_t i = aligned; i < std::min(aligned + 4, datagram.size()); ++i)
            datagram[i] = value;
          break;
        }
        case 4:
          datagram.resize(std::max<std::size_t>(place, 1));
          break;
        case 5:
          datagram.resize(datagram.size() + 1 + below(9), static_cast<std::uint8_t>(below(3)));
          break;
        default: {
          const Datagram& other = seen_[below(seen_.size())];
          if (other.size() <= 20) break;
          const std::size_t part = 20 + 4 * below((other.size() - 20) / 4);
          datagram.resize(place / 4 * 4);
          datagram.insert(datagram.end(), other.begin() + static_cast<std::ptrdiff_t>(part),
                          other.end());
          break;
        }
      }
    }
    if (datagram.size() > kLongest) datagram.resize(kLongest);
  }

  static constexpr std::size_t kLongest = 65'000;

  std::mutex mutex_;
  std::mt19937_64 random_;
  std::vector<Waiting> waiting_;
  std::array<Datagram, 64> seen_;
  std::size_t seen_count_ = 0;
  int copies_of_each_ = 0;
  long left_ = 0;
  bool is_paused_ = false;
};

BadNetwork& network() {
  static BadNetwork only;
  return only;
}

}  // namespace

// The function of the C library, as the sockets of this program call it.
extern "C" ssize_t recvfrom(int file, void* data, std::size_t room, int flags, sockaddr* from,
                            socklen_t* from_size) {
  return network().receive(file, data, room, flags, from, from_size);
}

namespace cordis::dds {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::eventually;

/// The participants of a session.
struct Members {
  ParticipantConfig sim;
  ParticipantConfig device;
  ParticipantConfig view;
};

/// A sim, a device and a view that exchange samples of all kinds: short ones, and frames in fragments.
struct Session {
  explicit Session(const Members& members)
      : sim(members.sim),
        device(members.device),
        view(members.view),
        forces(sim, Topic::kForces),
        frames(sim, Topic::kFrame),
        positions(device, Topic::kPositions),
        read_forces(device, Topic::kForces),
        read_frames(view, Topic::kFrame),
        read_positions(sim, Topic::kPositions) {}

  void write() {
    msg::GestureForces force;
    force.device_id(5);
    force.sample(++number);
    force.axis_count(1);
    msg::GesturePositions position;
    position.device_id(5);
    position.sample(number);
    position.axis_count(1);
    static_cast<void>(forces.write(force));
    static_cast<void>(positions.write(position));
    if (number % 8 != 1) return;
    msg::SceneFrame frame;
    frame.frame(number);
    frame.position_m().resize(60'000, 0.5F);
    static_cast<void>(frames.write(frame));
  }
  void take() {
    msg::GestureForces force;
    while (read_forces.take(force)) has_force = has_force || force.sample() == number;
    msg::GesturePositions position;
    while (read_positions.take(position))
      has_position = has_position || position.sample() == number;
    msg::SceneFrame frame;
    while (read_frames.take(frame))
      has_frame =
          has_frame || (frame.position_m().size() == 60'000 && frame.position_m()[0] == 0.5F);
  }
  /// True when one of each has come.
  bool exchanges() {
    return eventually([&] {
      write();
      read_forces.wait(2ms);
      take();
      return has_force && has_position && has_frame;
    });
  }

  Participant sim;
  Participant device;
  Participant view;
  Writer<msg::GestureForces> forces;
  Writer<msg::SceneFrame> frames;
  Writer<msg::GesturePositions> positions;
  Reader<msg::GestureForces> read_forces;
  Reader<msg::SceneFrame> read_frames;
  Reader<msg::GesturePositions> read_positions;
  std::uint64_t number = 0;
  bool has_force = false;
  bool has_position = false;
  bool has_frame = false;
};

Members members() {
  Members all;
  all.sim = {test::own_domain(), "changed", "sim"};
  all.device = {test::own_domain(), "changed", "hand"};
  all.view = {test::own_domain(), "changed", "view"};
  all.sim.for_loop = true;
  return all;
}

/// Starts a participant of Fast DDS alone, in a process of its own. @return its process
pid_t start_foreign_participant() {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child != 0) return child;
  using eprosima::fastdds::dds::DomainParticipantFactory;
  auto* participant = DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(test::own_domain()),
      eprosima::fastdds::dds::PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) _exit(3);
  for (;;) pause();
}

// The first of this process that uses DDS, for a fork takes no threads along.
TEST(APacketWithOneByteMore, EndsAParticipantOfFastDdsAndNoneOfCordis) {
  test::own_domain();
  const pid_t foreign = start_foreign_participant();
  Session session(members());
  ASSERT_TRUE(session.exchanges());
  std::optional<Datagram> packet = test::an_announcement();
  ASSERT_TRUE(packet);
  packet->push_back(0);
  int status = 0;
  EXPECT_TRUE(eventually([&] {
    test::send_to_all(*packet);
    return waitpid(foreign, &status, WNOHANG) == foreign;
  })) << "it is harmless";
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT) << status;
  for (int i = 0; i < 100; ++i) {
    test::send_to_all(*packet);
    session.has_force = session.has_position = session.has_frame = false;
    ASSERT_TRUE(session.exchanges()) << i;
  }
}

TEST(AReaderThatSaysItIsReliable, EndsNoWriterWhereItWasBestEffort) {
  Session session(members());
  ASSERT_TRUE(session.exchanges());
  std::optional<RawTopic> frames;
  for (const FoundWriter& found : session.view.writers())
    if (found.topic.name == msg::TOPIC_FRAME) frames = found.topic;
  ASSERT_TRUE(frames);
  test::ForeignReaders readers("changed", frames->name, frames->type, frames->keyed);
  const auto are_matched = [&](int count) {
    return eventually([&] {
      readers.send();
      return session.frames.matched_count() == count;
    });
  };
  readers.describe(1, false);
  ASSERT_TRUE(are_matched(2)) << "besides that of the session";

  readers.describe(1, true);
  readers.describe(2, false);
  ASSERT_TRUE(are_matched(3)) << "what was said before is known, too";
  for (int i = 0; i < 10; ++i) {
    session.has_force = session.has_position = session.has_frame = false;
    ASSERT_TRUE(session.exchanges()) << i;
  }
}

/// Plays changed copies into sessions, each for a while, for copies that pass may say that samples are lost, or
/// that a participant leaves. A session on a good network then exchanges as ever.
void play(const Members& members, long copies) {
  constexpr int kWritesOfASession = 300;
  constexpr int kOfEach = 8;
  const std::uint64_t seed = test::test_seed(20261129);
  eprosima::fastrtps::LibrarySettingsAttributes
      settings;  // else messages within a process need no datagram
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) std::signal(signal, keep_playing);
  std::printf("%ld copies, seed %llu\n", copies, static_cast<unsigned long long>(seed));
  network().begin(kOfEach, copies, seed);
  while (network().left() > 0) {
    network().pause();
    Session session(members);
    ASSERT_TRUE(session.exchanges()) << network().left() << " copies before the end";
    network().go_on();
    for (int i = 0; i < kWritesOfASession && network().left() > 0; ++i) {
      session.write();
      session.read_forces.wait(1ms);
      session.take();
    }
  }
  Session session(members);
  EXPECT_TRUE(session.exchanges());
}

long copies() {
  return number_of("CORDIS_DATAGRAMS", test::rounds(20'000));
}

TEST(ChangedDatagrams, EndNoParticipant) {
  play(members(), copies());
}

TEST(ChangedDatagrams, EndNoSecuredParticipant) {
  char name[] = "/tmp/cordis-test-XXXXXX";
  const fs::path folder = mkdtemp(name);
  node::make_keyring(folder / "keys", {});
  Members all = members();
  all.sim.security = node::identity_in(folder / "keys", {node::Role::kSim}, "").security;
  all.device.security = node::identity_in(folder / "keys", {node::Role::kDevice}, "").security;
  all.view.security = node::identity_in(folder / "keys", {node::Role::kView}, "").security;
  play(all, copies());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace cordis::dds
