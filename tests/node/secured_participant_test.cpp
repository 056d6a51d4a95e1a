// tests/node/secured_participant_test.cpp -- who reads and writes in a secured session.
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "idl/control.h"
#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "idl/topics.h"
#include "node/dds/arrival.h"
#include "node/dds/participant_ports.h"
#include "node/dds/payload.h"
#include "node/dds/reader.h"
#include "node/dds/secure_datagram.h"
#include "node/dds/udp_address.h"
#include "node/dds/wire_version.h"
#include "node/dds/writer.h"
#include "node/security/identity.h"
#include "node/security/keyring.h"
#include "node/time.h"
#include "tests/support/datagrams.h"
#include "tests/support/eventually.h"
#include "tests/support/rounds.h"
#include "tests/support/test_domain.h"

namespace cordis::dds {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using node::Role;
using test::eventually;

msg::GestureForces force_of(std::uint64_t sample, double newton) {
  msg::GestureForces force;
  force.device_id(5);
  force.epoch(9);
  force.sample(sample);
  force.axis_count(1);
  force.force_n()[0] = newton;
  return force;
}

class SecuredParticipant : public ::testing::Test {
 protected:
  SecuredParticipant() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    folder_ = mkdtemp(name);
    node::make_keyring(folder_ / "keys", {});
    node::make_keyring(folder_ / "others", {});
    node::add_key(folder_ / "keys", "page", Role::kViewThatCommands, folder_ / "keys", {});
  }
  ~SecuredParticipant() override { fs::remove_all(folder_); }

  static ParticipantConfig plain(const std::string& node) {
    return {test::own_domain(), "secured", node};
  }
  ParticipantConfig member(const std::string& node, Role role,
                           const std::string& ring = "keys") const {
    ParticipantConfig config = plain(node);
    config.security = node::identity_in(folder_ / ring, {role}, "").security;
    return config;
  }

  fs::path folder_;
};

/// A sim and a device of a session, and how much one receives of the other.
struct Pair {
  Pair(const ParticipantConfig& of_sim, const ParticipantConfig& of_device)
      : sim(of_sim), device(of_device), forces(sim, Topic::kForces), read(device, Topic::kForces) {}

  /// True when a force that is written now has come. Takes what was there before.
  bool one_comes() {
    msg::GestureForces force = force_of(++sample, 1.0);
    return eventually([&] {
      read.wait(5ms);
      static_cast<void>(forces.write(force));
      msg::GestureForces found;
      while (read.take(found)) {
        if (found.force_n()[0] != 1.0) return false;
        if (found.sample() == sample) return true;
      }
      return false;
    });
  }

  Participant sim;
  Participant device;
  Writer<msg::GestureForces> forces;
  Reader<msg::GestureForces> read;
  std::uint64_t sample = 0;
};

TEST_F(SecuredParticipant, ExchangesWithThoseOfItsKeyring) {
  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));

  EXPECT_TRUE(pair.one_comes());
  ASSERT_TRUE(eventually([&] { return pair.device.peers().size() == 1; }));
  EXPECT_EQ(pair.device.peers()[0].name, "secured/sim");
  EXPECT_EQ(pair.device.mismatch(), "");
}

TEST_F(SecuredParticipant, ExchangesWithALoopThatTakesItsSamplesItself) {
  ParticipantConfig of_loop = member("hand/loop", Role::kDevice);
  of_loop.for_loop = true;
  Participant sim(member("sim", Role::kSim));
  Participant device(of_loop);
  Arrival arrival;
  Reader<msg::GestureForces> read(device, Topic::kForces, &arrival);
  Writer<msg::GestureForces> forces(sim, Topic::kForces);

  msg::GestureForces force = force_of(1, 1.0);
  EXPECT_TRUE(eventually([&] {
    static_cast<void>(forces.write(force));
    static_cast<void>(arrival.wait_until(arrival.count(), node::monotonic_nsec() + 10'000'000));
    msg::GestureForces found;
    return read.take(found) && found.force_n()[0] == 1.0;
  }));
}

TEST_F(SecuredParticipant, GivesEachRoleItsTopicsAlone) {
  const auto refuses_to_write = [&](Role role, auto message, Topic topic) {
    Participant participant(member("x", role));
    try {
      const Writer<decltype(message)> writer(participant, topic);
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).starts_with("DDS refused to write");
    }
    return false;
  };

  for (const Role role : {Role::kView, Role::kViewThatCommands, Role::kRecorder, Role::kController,
                          Role::kLauncher}) {
    EXPECT_TRUE(refuses_to_write(role, msg::GesturePositions(), Topic::kPositions))
        << role_word(role);
    EXPECT_TRUE(refuses_to_write(role, msg::GestureForces(), Topic::kForces)) << role_word(role);
  }
  EXPECT_TRUE(refuses_to_write(Role::kView, msg::ControlCommand(), Topic::kCommand));
  EXPECT_TRUE(refuses_to_write(Role::kView, msg::PointerTarget(), Topic::kPointerTarget));
  EXPECT_FALSE(refuses_to_write(Role::kViewThatCommands, msg::ControlCommand(), Topic::kCommand));
  EXPECT_FALSE(
      refuses_to_write(Role::kViewThatCommands, msg::PointerTarget(), Topic::kPointerTarget));
  EXPECT_FALSE(refuses_to_write(Role::kController, msg::ControlCommand(), Topic::kCommand));
  EXPECT_FALSE(refuses_to_write(Role::kDevice, msg::GestureForces(), Topic::kForces));
  EXPECT_FALSE(refuses_to_write(Role::kPlayer, msg::GestureForces(), Topic::kForces));
  EXPECT_FALSE(refuses_to_write(Role::kPlayer, msg::SceneFrame(), Topic::kFrame));
}

TEST_F(SecuredParticipant, KeepsAKeyToTheSessionsThatItIsFor) {
  node::KeyOptions of_another;
  of_another.sessions = {"another"};
  node::add_key(folder_ / "keys", "hand", Role::kDevice, folder_ / "handed", of_another);
  ParticipantConfig config = member("hand", Role::kDevice, "handed");
  Participant participant(config);
  config.session = "another";
  Participant at_home(config);

  EXPECT_THROW(Writer<msg::GestureForces>(participant, Topic::kForces), std::runtime_error);
  EXPECT_NO_THROW(Writer<msg::GestureForces>(at_home, Topic::kForces));
}

/// A stranger reads, then another one writes what a session exchanges, for as long as it takes the
/// session to exchange 20 messages.
void expect_nothing_shared(Pair& pair, const ParticipantConfig& of_stranger) {
  {
    Participant stranger(of_stranger);
    Reader<msg::GestureForces> spy(stranger, Topic::kForces);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(pair.one_comes());
    msg::GestureForces found;
    EXPECT_FALSE(spy.take(found));
    EXPECT_EQ(spy.matched_count(), 0);
    EXPECT_TRUE(stranger.writers().empty());
    EXPECT_EQ(pair.forces.matched_count(), 1);
  }
  Participant stranger(of_stranger);
  Writer<msg::GestureForces> forger(stranger, Topic::kForces);
  msg::GestureForces forged = force_of(1'000'000, 666.0);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(forger.write(forged));
    ASSERT_TRUE(pair.one_comes());
  }
  EXPECT_EQ(forger.matched_count(), 0);
  EXPECT_EQ(pair.read.matched_count(), 1);
  EXPECT_EQ(pair.device.peers().size(), 1u);
  EXPECT_EQ(pair.device.mismatch(), "");
}

TEST_F(SecuredParticipant, SharesNothingWithAStrangerWithoutKeys) {
  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));
  ASSERT_TRUE(pair.one_comes());

  expect_nothing_shared(pair, plain("stranger"));
  EXPECT_TRUE(pair.one_comes()) << "after it has left";
}

TEST_F(SecuredParticipant, SharesNothingWithAStrangerOfAnotherKeyring) {
  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));
  ASSERT_TRUE(pair.one_comes());

  expect_nothing_shared(pair, member("stranger", Role::kSim, "others"));
  EXPECT_TRUE(pair.one_comes()) << "after it has left";
}

/// A message in the clear that carries the GUID of a writer.
/// @param hides  behind a submessage whose length is none of 4, so that who goes on at its end reads
/// others than Fast DDS, which goes on at the next multiple of 4
std::vector<std::uint8_t> forged_datagram(const WriterId& writer, std::uint32_t number,
                                          msg::GestureForces& force, bool hides) {
  std::vector<std::uint8_t> datagram{'R', 'T', 'P', 'S', 2, 3, 0x01, 0x0f};
  datagram.insert(datagram.end(), writer.begin(), writer.begin() + 12);
  const std::vector<std::byte> payload = encode(force);
  const auto put = [&datagram](std::initializer_list<int> bytes) {
    for (const int byte : bytes) datagram.push_back(static_cast<std::uint8_t>(byte));
  };
  const int more = hides ? 4 : 0;  // of the header of the sample
  const std::size_t length = 20 + payload.size() + static_cast<std::size_t>(more);
  if (hides) put({0x80, 0x01, 1, 0, 0, 0x80, 0, 0});
  put({0x15, 0x05, static_cast<int>(length & 0xff), static_cast<int>(length >> 8)});
  put({0, 0, 16 + more, 0, 0, 0, 0, 0});  // no inline QoS, to every reader
  datagram.insert(datagram.end(), writer.begin() + 12, writer.end());
  put({0, 0, 0, 0, static_cast<int>(number & 0xff), static_cast<int>(number >> 8)});
  if (hides) {
    put({0x80, 0x01, 0, 0, 0, 0});
  } else {
    put({0, 0});
  }
  for (const std::byte byte : payload) datagram.push_back(std::to_integer<std::uint8_t>(byte));
  return datagram;
}

WriterId writer_of_forces(const Pair& pair) {
  for (const FoundWriter& found : pair.device.writers()) {
    if (found.topic.name == msg::TOPIC_FORCES) return found.id;
  }
  throw std::runtime_error("the device has found no writer");
}

/// The announcement of a participant that says another name, process and version of the wire.
std::vector<std::uint8_t> forged_announcement(const WriterId& of_participant) {
  std::vector<std::uint8_t> list{0, 3, 0, 0};  // parameters, little-endian
  const auto put = [](std::vector<std::uint8_t>& to, std::vector<std::uint8_t> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
  };
  const std::vector<std::uint8_t> prefix(of_participant.begin(), of_participant.begin() + 12);
  const auto put_octets = [&](std::uint8_t parameter, std::string text) {
    const auto size = static_cast<std::uint8_t>(text.size());
    text.resize((text.size() + 3) / 4 * 4);
    put(list, {parameter, 0, static_cast<std::uint8_t>(4 + text.size()), 0, size, 0, 0, 0});
    put(list, {text.begin(), text.end()});
  };
  put(list, {0x15, 0, 4, 0, 2, 3, 0, 0});   // version of the protocol
  put(list, {0x16, 0, 4, 0, 1, 15, 0, 0});  // vendor
  put(list, {0x50, 0, 16, 0});
  put(list, prefix);
  put(list, {0, 0, 1, 0xc1});
  put(list, {0x58, 0, 4, 0, 0x3f, 0x0c, 0, 0});                                // its endpoints
  put(list, {0x02, 0, 8, 0, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff});  // no lease
  put_octets(0x62, std::string("secured/sim") + '\0');
  put_octets(0x2c, "process x" + wire_version_mark(77));
  put(list, {1, 0, 0, 0});

  std::vector<std::uint8_t> datagram{'R', 'T', 'P', 'S', 2, 3, 0x01, 0x0f};
  put(datagram, prefix);
  put(datagram, {0x15, 0x05, static_cast<std::uint8_t>(20 + list.size()), 0, 0, 0, 16, 0});
  put(datagram, {0, 1, 0, 0xc7, 0, 1, 0, 0xc2, 0, 0, 0, 0, 0, 0, 0, 0x40});  // a high number
  put(datagram, list);
  return datagram;
}

/// True if a force that a stranger forges, in the name of sim, reaches the device.
bool forgery_comes(Pair& pair, bool hides) {
  const WriterId writer = writer_of_forces(pair);
  msg::GestureForces forged = force_of(1'000'000, 666.0);
  bool has_come = false;
  for (std::uint32_t number = 30'000; number < 30'050 && !has_come; ++number) {
    test::send_to_all(forged_datagram(writer, number, forged, hides));
    pair.read.wait(10ms);
    for (msg::GestureForces found; pair.read.take(found);)
      has_come = has_come || found.force_n()[0] == 666.0;
  }
  return has_come;
}

TEST_F(SecuredParticipant, TakesNoMessageInTheClearInTheNameOfAnother) {
  Pair open(plain("sim"), plain("hand"));
  ASSERT_TRUE(open.one_comes());
  EXPECT_TRUE(forgery_comes(open, false)) << "the forgery is one: without security it is taken";
  EXPECT_FALSE(forgery_comes(open, true))
      << "a message that can be read in two ways is taken by none";

  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));
  ASSERT_TRUE(pair.one_comes());
  EXPECT_FALSE(forgery_comes(pair, false));
  EXPECT_FALSE(forgery_comes(pair, true));
  EXPECT_TRUE(pair.one_comes());
}

TEST_F(SecuredParticipant, BelievesNoAnnouncementInTheNameOfOneThatHasProvenWhoItIs) {
  const auto has_mismatch = [](Pair& pair) {
    const std::vector<std::uint8_t> announcement = forged_announcement(writer_of_forces(pair));
    bool found = false;
    for (int i = 0; i < 20 && !found; ++i) {
      test::send_to_all(announcement);
      pair.read.wait(10ms);
      found = !pair.device.mismatch().empty();
    }
    return found;
  };
  {
    Pair open(plain("sim"), plain("hand"));
    ASSERT_TRUE(open.one_comes());
    EXPECT_TRUE(has_mismatch(open)) << "the announcement is one: without security it is believed";
  }
  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));
  ASSERT_TRUE(pair.one_comes());
  EXPECT_FALSE(has_mismatch(pair));
  EXPECT_TRUE(pair.one_comes());
}

TEST_F(SecuredParticipant, SaysToOneWithoutKeysThatTheOthersHaveThem) {
  Pair pair(member("sim", Role::kSim), member("hand", Role::kDevice));
  ASSERT_TRUE(pair.one_comes());
  const Participant stranger(plain("view"));
  ParticipantConfig of_neighbour = plain("view");
  of_neighbour.session = "another";
  const Participant neighbour(of_neighbour);
  of_neighbour.every_partition = true;
  const Participant reader_of_all(of_neighbour);

  for (const Participant* participant : {&stranger, &reader_of_all}) {
    EXPECT_TRUE(eventually([&] {
      return participant->mismatch().find("is secured, and this process has no keys") !=
             std::string::npos;
    })) << participant->mismatch();
  }
  EXPECT_EQ(neighbour.mismatch(), "");
  EXPECT_EQ(pair.device.mismatch(), "");
}

TEST_F(SecuredParticipant, SaysWhyItsSessionIsEmptyUntilItIsNot) {
  const auto has_said = [](const Participant& participant, const char* what) {
    return eventually([&] { return participant.mismatch().find(what) != std::string::npos; });
  };
  const Participant sim(member("sim", Role::kSim));
  {
    const Participant without(plain("view"));
    EXPECT_TRUE(has_said(sim, "'secured/view' has no keys")) << sim.mismatch();
  }
  EXPECT_TRUE(eventually([&] { return sim.mismatch().empty(); })) << "it has left";
  const Participant of_others(member("view", Role::kView, "others"));
  EXPECT_TRUE(has_said(sim, "'secured/view' and this process")) << sim.mismatch();
  EXPECT_TRUE(has_said(of_others, "'secured/sim' and this process")) << of_others.mismatch();

  const Participant device(member("hand", Role::kDevice));
  EXPECT_TRUE(eventually([&] { return sim.mismatch().empty(); })) << sim.mismatch();
}

TEST_F(SecuredParticipant, FindsOneAgainThatLeftAndCameBack) {
  Participant device(member("hand", Role::kDevice));
  Reader<msg::GestureForces> read(device, Topic::kForces);
  for (int life = 0; life < 3; ++life) {
    Participant sim(member("sim", Role::kSim));
    Writer<msg::GestureForces> forces(sim, Topic::kForces);
    msg::GestureForces force = force_of(1, life + 1.0);
    EXPECT_TRUE(eventually([&] {
      static_cast<void>(forces.write(force));
      msg::GestureForces found;
      return read.take(found) && found.force_n()[0] == life + 1.0;
    })) << life;
  }
}

TEST_F(SecuredParticipant, OutlivesTheLastReceiverOfWhatItSends) {
  std::vector<std::jthread> sims;
  for (int i = 0; i < 4; ++i) {  // so many that the one that sends is held up now and then
    sims.emplace_back([&](const std::stop_token& end) {
      Participant sim(member("sim", Role::kSim));
      Writer<msg::SceneFrame> frames(sim, Topic::kFrame);
      msg::SceneFrame frame;
      for (int sent = 0; !end.stop_requested(); ++sent) {
        static_cast<void>(frames.write(frame));
        if (sent % 4 == 0) std::this_thread::sleep_for(50us);
      }
    });
  }
  for (int life = 0; life < test::rounds(20); ++life) {
    Participant view(member("view", Role::kView));
    Reader<msg::SceneFrame> read(view, Topic::kFrame);
    EXPECT_TRUE(eventually([&] {
      msg::SceneFrame frame;
      return read.take(frame);
    })) << life;
  }
}

/// What waits for one that comes late is sent together, in messages as long as a datagram may be.
/// Encryption makes them longer. The sizes end such messages at every length.
TEST_F(SecuredParticipant, GetsAllThatWasWrittenBeforeItCame) {
  constexpr std::uint64_t kKept = 256;  // by the writer of this topic
  for (std::size_t size = 0; size < 24; size += 4) {
    Participant sim(member("sim", Role::kSim));
    Writer<msg::SceneInputs> inputs(sim, Topic::kInputs);
    msg::SceneInputs written;
    written.engine_version(std::string(300 + size, '1'));
    for (std::uint64_t batch = 1; batch <= kKept; ++batch) {
      written.batch(batch);
      ASSERT_TRUE(inputs.write(written));
    }

    Participant recorder(member("record", Role::kRecorder));
    Reader<msg::SceneInputs> read(recorder, Topic::kInputs);
    std::uint64_t expected = 1;
    EXPECT_TRUE(eventually([&] {
      msg::SceneInputs found;
      while (read.take(found)) EXPECT_EQ(found.batch(), expected++);
      return expected > kKept;
    })) << size
        << " " << expected;
  }
}

TEST(SecureDatagram, IsFitWhenItIsEncryptedOrFindsParticipants) {
  const auto message = [](std::vector<std::uint8_t> submessages) {
    std::vector<std::uint8_t> bytes(20, 0);
    std::memcpy(bytes.data(), "RTPS", 4);
    bytes.insert(bytes.end(), submessages.begin(), submessages.end());
    return bytes;
  };
  const auto is_fit = [](const std::vector<std::uint8_t>& bytes) {
    return is_fit_for_secured(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  };
  const std::vector<std::uint8_t> announcement{0x15, 0x05, 16, 0, 0, 0,    16, 0, 0, 1,
                                               0,    0xc7, 0,  1, 0, 0xc2, 0,  0, 0, 0};
  const std::vector<std::uint8_t> handshake{0x15, 0x05, 16, 0, 0, 0,    16, 0, 0, 2,
                                            1,    0xc4, 0,  2, 1, 0xc3, 0,  0, 0, 0};
  std::vector<std::uint8_t> sample = announcement;
  sample[15] = 0x03;
  std::vector<std::uint8_t> both = announcement;
  both.insert(both.end(), sample.begin(), sample.end());
  std::vector<std::uint8_t> too_long = announcement;
  too_long[2] = 17;

  EXPECT_TRUE(is_fit(message({0x33, 1, 4, 0, 1, 2, 3, 4})));
  EXPECT_TRUE(is_fit(message(announcement)));
  EXPECT_TRUE(is_fit(message(handshake)));
  EXPECT_FALSE(is_fit(message(sample)));
  EXPECT_FALSE(is_fit(message(both)));
  EXPECT_FALSE(is_fit(message(too_long)));
  // Fast DDS goes on 8 bytes behind the beginning of the first, and not 5.
  EXPECT_FALSE(is_fit(message({0x80, 0x01, 1, 0, 0, 0x80, 0, 0, 0})));
  EXPECT_TRUE(is_fit(message({0x80, 0x01, 4, 0, 0, 0, 0, 0, 0x80, 0, 0, 0})));
  EXPECT_FALSE(is_fit(message({0x07, 1, 0, 0})));  // heartbeat
  EXPECT_FALSE(is_fit(message({0x06, 1, 0, 0})));  // acknowledgement
  EXPECT_FALSE(is_fit(message({0x08, 1, 0, 0})));  // gap
  EXPECT_FALSE(is_fit(message({})));
  const std::vector<std::uint8_t> whole = message(announcement);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(is_fit({whole.data(), whole.data() + size})) << size;
}

}  // namespace
}  // namespace cordis::dds
