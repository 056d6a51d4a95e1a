// tests/cli/run_domain_test.cpp -- which DDS domain a session of `cordis run` has, and that a
// second one does not disturb it.
#include <regex>

#include "node/instance_lock.h"
#include "node/session_registry.h"
#include "tests/cli/fake_session.h"

namespace cordis::test {
namespace {

/// A session whose launch file names no domain.
class RunDomain : public testing::Test {
 protected:
  RunDomain() {
    session_.own_registry();
    session_.announce();
  }

  /// The domain of the line that says it; -1 when there is none.
  static int domain_of(ChildProcess& run) {
    run.wait_for_output("in DDS domain ", kPatience);
    std::smatch found;
    const std::string output = run.output();
    const std::regex line(R"(cordis \| session '\w+' in DDS domain (\d+)\n)");
    return std::regex_search(output, found, line) ? std::stoi(found[1]) : -1;
  }

  FakeSession session_;
};

TEST_F(RunDomain, IsLockedReportedAndPassedToTheNodes) {
  session_.node("sim", "words;pid");
  const auto run = session_.start();
  ASSERT_TRUE(wait_for_all(*run)) << run->output();

  const int domain = domain_of(*run);

  ASSERT_GE(domain, 0) << run->output();
  EXPECT_NE(run->output().find("--name sim domain=" + std::to_string(domain) + "\n"),
            std::string::npos)
      << run->output();
  const auto running = node::running_sessions(session_.directory() / "runtime");
  ASSERT_EQ(running.size(), 1u);
  EXPECT_EQ(running[0].session, "fake");
  EXPECT_EQ(running[0].domain, domain);
  EXPECT_EQ(running[0].launch_file, session_.launch_file());
  EXPECT_EQ(running[0].members.at(0).process, run->id());
  run->signal(SIGTERM);
  EXPECT_EQ(end_of(*run), 0);
  EXPECT_TRUE(node::running_sessions(session_.directory() / "runtime").empty());
}

TEST_F(RunDomain, IsAnotherForASessionOfAnotherName) {
  const auto one = session_.start();
  ASSERT_TRUE(wait_for_all(*one));
  const auto other = session_.start({"session=other"});
  ASSERT_TRUE(wait_for_all(*other));

  EXPECT_GE(domain_of(*one), 0);
  EXPECT_GE(domain_of(*other), 0);
  EXPECT_NE(domain_of(*one), domain_of(*other));
}

TEST_F(RunDomain, IsRefusedToASecondRunOfTheSession) {
  const auto first = session_.start();
  ASSERT_TRUE(wait_for_all(*first));
  const std::string domain = std::to_string(domain_of(*first));

  const auto second = session_.start();

  EXPECT_EQ(end_of(*second), 1);
  EXPECT_EQ(second->output(), "cordis run: session 'fake' already runs in DDS domain " + domain +
                                  " with a node named 'sim' (process " +
                                  std::to_string(first->id()) +
                                  "); stop it, or give this one session=NAME\n");
  EXPECT_EQ(first->wait(std::chrono::milliseconds(0)), -1) << "the first goes on";
}

TEST_F(RunDomain, HasNoSecondNodeOfANameOfAnotherUser) {
  for (const auto& [lock, node] :
       {std::pair("sim_node", "a sim_node"), std::pair("key", "a node named 'key'")}) {
    FakeSession session;
    session.announce();
    const std::string name = "cordis/" + std::to_string(own_domain()) + "/fake/" + lock;
    const int held = node::try_to_lock(name.c_str());  // as the node of another user does
    ASSERT_GE(held, 0);

    const auto run = session.start();

    EXPECT_EQ(end_of(*run), 1);
    EXPECT_EQ(count_of(run->output(), "session 'fake' already runs in DDS domain " +
                                          std::to_string(own_domain()) + " with " + node +
                                          " of another user; stop it, or give this one "
                                          "session=NAME\n"),
              1u)
        << run->output();
    EXPECT_EQ(count_of(run->output(), "| pid"), 0u) << "nothing was started\n" << run->output();
    close(held);
  }
}

TEST_F(RunDomain, IsSharedByRunsOfDifferentNodesOfOneSession) {
  const auto loop = session_.start({"--only", "sim,key"});
  ASSERT_TRUE(loop->wait_for_output("key    | pid", kPatience));
  const auto view = session_.start({"--only", "view"});
  ASSERT_TRUE(view->wait_for_output("view   | pid", kPatience));

  EXPECT_GE(domain_of(*loop), 0);
  EXPECT_EQ(domain_of(*view), domain_of(*loop));
}

TEST_F(RunDomain, LetsANodeThatHasEndedBeStartedByItself) {
  session_.node("view", "exit 0");
  const auto loop = session_.start();
  ASSERT_TRUE(loop->wait_for_output("view: has ended; the others go on\n", kPatience));
  session_.node("view", "pid");

  const auto view = session_.start({"--only", "view"});

  ASSERT_TRUE(view->wait_for_output("view   | pid", kPatience)) << view->output();
  EXPECT_EQ(domain_of(*view), domain_of(*loop));
}

TEST_F(RunDomain, OfAKilledRunIsFreeAgain) {
  const auto killed = session_.start();
  ASSERT_TRUE(wait_for_all(*killed));
  killed->signal(SIGKILL);
  ASSERT_EQ(end_of(*killed), 128 + SIGKILL);

  const auto next = session_.start();

  EXPECT_TRUE(wait_for_all(*next)) << next->output();
}

TEST_F(RunDomain, ThatIsNamedWins) {
  const std::string named = "domain=" + std::to_string(own_domain());
  session_.node("sim", "words;pid");
  const auto run = session_.start({named});
  ASSERT_TRUE(wait_for_all(*run));

  EXPECT_EQ(domain_of(*run), own_domain());
  EXPECT_NE(run->output().find("--name sim " + named + "\n"), std::string::npos) << run->output();
}

}  // namespace
}  // namespace cordis::test
