// tests/node/session_registry_test.cpp -- every session of a host has a DDS domain of its own.
#include "node/session_registry.h"

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "node/dds/process_identity.h"
#include "node/runtime_folder.h"
#include "node/session_key.h"
#include "tests/support/test_seed.h"

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

/// A folder of a test's own, gone with the object.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  operator fs::path() const { return path_; }  // NOLINT(google-explicit-constructor)
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// A process that is a session's node until it is killed or asked to end.
class RegisteredSession {
 public:
  RegisteredSession(const fs::path& folder, const SessionRequest& request) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("pipe");
    id_ = fork();
    if (id_ == 0) {
      close(ends[0]);
      play(folder, request, ends[1]);
    }
    close(ends[1]);
    report_ = ends[0];
  }
  ~RegisteredSession() { end(SIGKILL); }
  RegisteredSession(const RegisteredSession&) = delete;
  RegisteredSession& operator=(const RegisteredSession&) = delete;

  pid_t id() const noexcept { return id_; }

  /// The domain that it was given; -1 when it was refused, or died before it could say so.
  int domain() {
    int domain = -1;
    if (report_ >= 0 && read(report_, &domain, sizeof domain) == sizeof domain) domain_ = domain;
    if (report_ >= 0) close(report_);
    report_ = -1;
    return domain_;
  }

  /// SIGKILL: it dies. SIGTERM: it ends in order.
  void end(int signal) {
    if (id_ < 0) return;
    kill(id_, signal);
    waitpid(id_, nullptr, 0);
    id_ = -1;
    if (report_ >= 0) close(report_);
    report_ = -1;
  }

 private:
  [[noreturn]] static void play(const fs::path& folder, const SessionRequest& request, int report) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGTERM);
    sigprocmask(SIG_BLOCK, &ends, nullptr);
    int domain = -1;
    try {
      const SessionRegistration registration(folder, request);
      domain = registration.domain();
      if (write(report, &domain, sizeof domain) < 0) _exit(1);
      int signal = 0;
      sigwait(&ends, &signal);
    } catch (const std::exception&) {
      if (write(report, &domain, sizeof domain) < 0) _exit(1);
      int signal = 0;
      sigwait(&ends, &signal);
    }
    _exit(0);
  }

  pid_t id_ = -1;
  int report_ = -1;
  int domain_ = -1;
};

SessionRequest request_of(const std::string& session, const std::string& node) {
  return {session, std::nullopt, "/lab/" + session + ".yaml", {node}};
}

std::string refusal_of(const fs::path& folder, const SessionRequest& request) {
  try {
    const SessionRegistration registration(folder, request);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "(not refused)";
}

TEST(SessionRegistry, GivesEverySessionADomainOfItsOwnAndRecordsIt) {
  const Folder folder;
  const SessionRegistration one(folder, request_of("one", "sim"));
  RegisteredSession two(folder, request_of("two", "sim"));

  ASSERT_GE(two.domain(), 0);
  EXPECT_NE(two.domain(), one.domain());
  const std::vector<SessionRecord> running = running_sessions(folder);
  ASSERT_EQ(running.size(), 2u);
  EXPECT_EQ(running[0].session, "one");
  EXPECT_EQ(running[0].domain, one.domain());
  EXPECT_EQ(running[0].launch_file, "/lab/one.yaml");
  ASSERT_EQ(running[0].members.size(), 1u);
  EXPECT_EQ(running[0].members[0].process, getpid());
  EXPECT_EQ(running[0].members[0].nodes, std::vector<std::string>{"sim"});
  EXPECT_EQ(running[1].session, "two");
  EXPECT_EQ(running[1].members[0].process, two.id());
}

TEST(SessionRegistry, KnowsTheDomainThatTheNextSessionIsGiven) {
  const Folder folder;
  const SessionRegistration one(folder, request_of("one", "sim"));
  const int next = domain_of_next_session(folder);
  EXPECT_NE(next, one.domain());
  EXPECT_NE(next, 0) << "it comes last";
  EXPECT_EQ(running_sessions(folder).size(), 1u);
}

TEST(SessionRegistry, LetsNodesOfOneSessionMeetInItsDomain) {
  const Folder folder;
  RegisteredSession sim(folder, request_of("string", "sim"));
  ASSERT_GE(sim.domain(), 0);
  RegisteredSession view(folder, request_of("string", "view"));
  EXPECT_EQ(view.domain(), sim.domain());

  sim.end(SIGKILL);
  RegisteredSession other(folder, request_of("other", "sim"));
  EXPECT_NE(other.domain(), view.domain()) << "the view is still there";
  RegisteredSession again(folder, request_of("string", "sim"));
  EXPECT_EQ(again.domain(), view.domain());
}

TEST(SessionRegistry, KeepsOneKeyPerSessionAsLongAsItRuns) {
  const Folder folder;
  const auto keyed = [](const std::string& node) {
    SessionRequest request = request_of("string", node);
    request.has_key = true;
    return request;
  };
  std::optional<SessionKey> first;
  int domain = -1;
  {
    RegisteredSession by_hand(folder, request_of("string", "hand"));
    domain = by_hand.domain();
    ASSERT_GE(domain, 0);
    const fs::path file = registered_key_file(folder, "string", domain);
    EXPECT_FALSE(fs::exists(file)) << "a node alone makes no key";
    RegisteredSession launcher(folder, keyed("sim"));
    ASSERT_EQ(launcher.domain(), domain);
    first = read_key_file(file);
    RegisteredSession second(folder, keyed("view"));
    ASSERT_EQ(second.domain(), domain);
    EXPECT_EQ(read_key_file(file), *first);
    second.end(SIGTERM);
    launcher.end(SIGTERM);
    EXPECT_EQ(read_key_file(file), *first) << "the session goes on";
    by_hand.end(SIGTERM);
    EXPECT_FALSE(fs::exists(file));
  }
  SessionRequest again = keyed("sim");
  again.domain = domain;
  RegisteredSession killed(folder, again);
  ASSERT_EQ(killed.domain(), domain);
  const SessionKey other = read_key_file(registered_key_file(folder, "string", domain));
  EXPECT_NE(other, *first);
  killed.end(SIGKILL);
  EXPECT_TRUE(running_sessions(folder).empty());
  EXPECT_FALSE(fs::exists(registered_key_file(folder, "string", domain)));
}

TEST(SessionRegistry, TakesTheKeyOfAChosenFileAndRefusesASecondOne) {
  const Folder folder;
  const fs::path chosen = folder / "chosen";
  const SessionKey key = SessionKey::random();
  write_key_file(chosen, key);
  setenv("CORDIS_SESSION_KEY_FILE", chosen.c_str(), /*overwrite=*/1);
  SessionRequest request = request_of("string", "sim");
  request.has_key = true;
  {
    const SessionRegistration registration(folder, request);
    EXPECT_EQ(read_key_file(registered_key_file(folder, "string", registration.domain())), key);
    write_key_file(chosen, SessionKey::random());
    request.nodes = {"view"};
    EXPECT_NE(refusal_of(folder, request).find("runs with another key than that of"),
              std::string::npos);
  }
  unsetenv("CORDIS_SESSION_KEY_FILE");
}

TEST(SessionRegistry, KeepsThoseWithKeysAndThoseWithoutApart) {
  const Folder folder;
  SessionRequest secured = request_of("bow", "sim");
  secured.keyring = "/home/me/the keys";
  const SessionRegistration of_secured(folder, secured);
  const SessionRegistration of_open(folder, request_of("string", "sim"));
  secured.session = "string";
  secured.nodes = {"view"};

  EXPECT_EQ(running_sessions(folder)[0].keyring, "/home/me/the keys");
  EXPECT_EQ(running_sessions(folder)[1].keyring, "");
  EXPECT_NE(
      refusal_of(folder, request_of("bow", "view")).find("with the keys of /home/me/the keys, and"),
      std::string::npos);
  EXPECT_NE(refusal_of(folder, secured).find("without keys, and this part of it has those of"),
            std::string::npos);
}

TEST(SessionRegistry, RefusesASecondNodeOfOneNameAndSaysWhatToDo) {
  const Folder folder;
  const SessionRegistration first(folder, request_of("string", "sim"));

  EXPECT_EQ(refusal_of(folder, request_of("string", "sim")),
            "session 'string' already runs in DDS domain " + std::to_string(first.domain()) +
                " with a node named 'sim' (process " + std::to_string(getpid()) +
                "); stop it, or give this one session=NAME");
  EXPECT_EQ(running_sessions(folder).size(), 1u);
}

TEST(SessionRegistry, LetsADomainThatIsNamedWin) {
  const Folder folder;
  const SessionRegistration locked(folder, request_of("string", "sim"));
  const int other_domain = locked.domain() == 50 ? 51 : 50;
  SessionRequest named = request_of("string", "sim");
  named.domain = other_domain;
  const SessionRegistration elsewhere(folder, named);

  EXPECT_EQ(elsewhere.domain(), other_domain);
  const std::string refusal = refusal_of(folder, request_of("string", "view"));
  EXPECT_NE(
      refusal.find("runs in domains " + std::to_string(std::min(locked.domain(), other_domain)) +
                   " and " + std::to_string(std::max(locked.domain(), other_domain))),
      std::string::npos)
      << refusal;
  EXPECT_NE(refusal.find("domain=N"), std::string::npos) << refusal;
}

TEST(SessionRegistry, RemovesWhatTheDeadAndReusedNumbersLeft) {
  const Folder folder;
  const std::string me = dds::process_identity();
  const std::size_t start = me.rfind(' ');
  const auto write_file = [&](const std::string& name, const std::string& identity) {
    std::ofstream(folder / (name + ".7.session"))
        << "session " << name << "\ndomain 7\nlaunch_file /x\nmember " << getpid()
        << " sim\nidentity " << identity << '\n';
  };
  write_file("mine", me);
  ASSERT_EQ(running_sessions(folder).size(), 1u) << "the form of a file is as the test writes it";
  fs::remove(folder / "mine.7.session");
  write_file("dead", me.substr(0, start) + " " + std::to_string(std::stoull(me.substr(start)) + 1));
  write_file("elsewhere", "process another-boot 1 " + me.substr(start));
  std::ofstream(folder / "torn.8.session") << "sess";
  {
    const SessionRegistration living(folder, request_of("living", "sim"));
    ASSERT_EQ(running_sessions(folder).size(), 1u);
    EXPECT_FALSE(fs::exists(folder / "dead.7.session"));
    EXPECT_FALSE(fs::exists(folder / "elsewhere.7.session"));
    EXPECT_FALSE(fs::exists(folder / "torn.8.session"));
  }
  EXPECT_TRUE(running_sessions(folder).empty()) << "one that ends leaves nothing";
}

TEST(SessionRegistry, PassesOverADomainThatAForeignProgramUses) {
  const Folder folder;
  int first = 0;
  {
    const SessionRegistration probe(folder, request_of("probe", "sim"));
    first = probe.domain();
  }
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * first + 13));
  ASSERT_EQ(bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);

  const SessionRegistration beside(folder, request_of("beside", "sim"));
  EXPECT_NE(beside.domain(), first);
  close(file);
}

TEST(SessionRegistry, PassesOverADomainThatAnotherUserHolds) {
  const Folder mine;
  const Folder theirs;
  RegisteredSession other(theirs, request_of("string", "sim"));
  ASSERT_GE(other.domain(), 0);

  const SessionRegistration own(mine, request_of("string", "sim"));

  EXPECT_NE(own.domain(), other.domain());
}

TEST(SessionRegistry, UsesNoFolderThatIsNotItsUsersOwn) {
  const Folder folder;
  fs::create_directory(folder / "open");
  chmod((folder / "open").c_str(), 0777);
  fs::create_directory_symlink("/tmp", folder / "link");
  std::ofstream(folder / "file") << "x";

  EXPECT_THROW(make_private_folder(folder / "open"), std::runtime_error);
  EXPECT_THROW(make_private_folder(folder / "link"), std::runtime_error);
  EXPECT_THROW(make_private_folder(folder / "file"), std::runtime_error);
  EXPECT_THROW(make_private_folder("/proc/none"), std::runtime_error);
  make_private_folder(folder / "new");
  EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms::owner_all);
}

TEST(SessionRegistry, DoesNotWaitForEverForAProcessThatStandsStillWithTheLock) {
  const Folder folder;
  const FolderLock held(folder);
  EXPECT_THROW(FolderLock(folder, std::chrono::milliseconds(20)), std::runtime_error);
}

/// Sessions of two users start, die at any moment (in the middle of a lock too), end, and start
/// again, several at once. At no time do two that live have one domain, and the nodes of one
/// session always share theirs.
TEST(SessionRegistry, NeverGivesOneDomainToTwoSessionsWhateverHappens) {
  const std::uint32_t seed = test::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto pick = [&random](int count) { return static_cast<int>(random() % count); };
  const std::array<Folder, 2> users;
  // (user, session, node) to the process that plays it
  std::map<std::array<int, 3>, std::unique_ptr<RegisteredSession>> living;
  int checked = 0;

  for (int round = 0; round < 40; ++round) {
    for (int start = pick(6); start >= 0; --start) {
      const std::array<int, 3> who{pick(2), pick(5), pick(3)};
      if (living[who] != nullptr) continue;
      living[who] = std::make_unique<RegisteredSession>(
          users[static_cast<std::size_t>(who[0])],
          request_of("s" + std::to_string(who[1]), "n" + std::to_string(who[2])));
      if (pick(4) == 0) {
        usleep(static_cast<useconds_t>(pick(3000)));
        living[who].reset();
      }
    }
    std::map<int, std::pair<int, int>> session_in;  // by domain
    std::map<std::pair<int, int>, int> domain_of;
    for (auto& [who, registered] : living) {
      if (registered == nullptr) continue;
      const int domain = registered->domain();
      ASSERT_GE(domain, 0) << "refused in round " << round;
      const std::pair session{who[0], who[1]};
      const auto [entry, is_new] = session_in.emplace(domain, session);
      ASSERT_EQ(entry->second, session) << "domain " << domain << " in round " << round;
      ASSERT_EQ(domain_of.emplace(session, domain).first->second, domain) << "round " << round;
      ++checked;
    }
    for (auto& [who, registered] : living) {
      const int fate = pick(5);
      if (registered == nullptr || fate > 1) continue;
      registered->end(fate == 0 ? SIGKILL : SIGTERM);
      registered.reset();
    }
  }
  EXPECT_GT(checked, 100);
  living.clear();
  for (const Folder& user : users) EXPECT_TRUE(running_sessions(user).empty());
}

TEST(SessionRegistry, KeepsSceneAndDevicesOutOfATakeThatIsPlayed) {
  const Folder folder;
  const SessionRegistration played(folder, {"string", {}, "", {"play"}, true});
  const auto join = [&](const std::string& node, bool simulates) {
    const SessionRegistration joined(folder, {"string", {}, "", {node}, false, simulates});
    return joined.domain();
  };
  try {
    join("sim", true);
    ADD_FAILURE() << "a scene has joined a take";
  } catch (const SessionRuns&) {
    ADD_FAILURE() << "of `cordis play` alone";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "session 'string' in DDS domain " + std::to_string(played.domain()) +
                                " is a take that is played (process " + std::to_string(getpid()) +
                                "); stop it, or give this one session=NAME");
  }
  EXPECT_EQ(join("view", false), played.domain()) << "a viewer may";
}

TEST(SessionRegistry, KeepsANewSessionOutOfOneThatRuns) {
  const Folder folder;
  const SessionRegistration running(folder, {"string", {}, "", {"sim"}});
  const auto is_refused = [&](std::optional<int> domain) {
    try {
      const SessionRegistration played(folder, {"string", domain, "", {"play"}, true});
      return false;
    } catch (const SessionRuns&) {
      return true;
    }
  };
  EXPECT_TRUE(is_refused({}));
  EXPECT_TRUE(is_refused(running.domain()));
  EXPECT_NO_THROW(SessionRegistration(folder, {"other", {}, "", {"play"}, true}));
}

}  // namespace
}  // namespace cordis::node
