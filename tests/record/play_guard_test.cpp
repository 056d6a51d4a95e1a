// tests/record/play_guard_test.cpp -- what `cordis play` refuses, so that nothing floods or moves.
#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/record/count_take.h"
#include "tests/support/child_process.h"

namespace cordis {
namespace {

using test::ChildProcess;

const std::string kGuardedCordis = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

class PlayGuard : public ::testing::Test {
 protected:
  PlayGuard() { test::write_count_take(take_); }

  /// `cordis` in the domain of this test.
  std::vector<std::string> words(const std::string& verb, const std::string& what,
                                 const std::vector<std::string>& more) const {
    std::vector<std::string> all{kGuardedCordis, verb, what, "--domain",
                                 std::to_string(test::own_domain())};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void refuses(const std::vector<std::string>& all, int code, const std::string& says) const {
    ChildProcess program(all);
    EXPECT_EQ(program.wait(test::kPatience), code) << program.output();
    EXPECT_NE(program.output().find(says), std::string::npos) << program.output();
  }

  mcap::TakeFolder folder_;
  const std::string take_ = folder_ / "take.mcap";
};

TEST_F(PlayGuard, NeverJoinsASessionThatRuns) {
  ChildProcess first(words("play", take_, {"--start-paused"}));
  ASSERT_TRUE(first.wait_for_output("session 'count'", test::kPatience));
  refuses(words("play", take_, {}), 2, "--session NAME");
  ChildProcess beside(words("play", take_, {"--session", "beside", "--rate", "20"}));
  EXPECT_EQ(beside.wait(test::kPatience), 0) << beside.output();
  first.signal(SIGINT);
  EXPECT_EQ(first.wait(test::kPatience), 0) << first.output();
}

TEST_F(PlayGuard, LetsNoSceneAndNoDeviceJoinATakeThatIsPlayed) {
  ChildProcess player(words("play", take_, {"--start-paused"}));
  ASSERT_TRUE(player.wait_for_output("session 'count'", test::kPatience));
  const std::string launch = CORDIS_SOURCE_DIR "/launch_configs/plucked_string.yaml";
  const std::string domain = "domain=" + std::to_string(test::own_domain());
  const std::string refusal = "session 'count' in DDS domain " +
                              std::to_string(test::own_domain()) + " is a take that is played";
  refuses({kGuardedCordis, "run", launch, "session=count", domain}, 1, refusal);
  refuses({kGuardedCordis, "run", launch, "session=count", domain, "--only", "keyboard"}, 1,
          refusal);
  refuses({std::string(CORDIS_PROGRAM_DIR) + "/sim_node", launch, "session=count", domain}, 1,
          refusal);
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(test::kPatience), 0) << player.output();
}

TEST_F(PlayGuard, NamesTheOptionOfALength) {
  refuses(words("play", take_, {"--duration", "1s"}), 2,
          "unknown option '--duration', did you mean '--playback-duration'?");
}

TEST_F(PlayGuard, RefusesToRepeatWhatHasNoLength) {
  refuses(words("play", take_, {"--loop", "--start-offset", "780ms"}), 1, "has no length");
}

TEST_F(PlayGuard, RefusesRatesAndStepsOutOfRange) {
  for (const char* rate : {"1e-12", "1e4", "nan"})
    refuses(words("play", take_, {"--rate", rate}), 2, "from 0.001 to 1000");
  ChildProcess player(words("play", take_, {"--start-paused"}));
  ASSERT_TRUE(player.wait_for_output("session 'count'", test::kPatience));
  refuses(words("ctl", "count", {"rate", "1e-12"}), 2, "from 0.001 to 1000");
  refuses(words("ctl", "count", {"step", "1e300"}), 2, "from 1 to 1000000");
  player.signal(SIGINT);
  EXPECT_EQ(player.wait(test::kPatience), 0) << player.output();
}

}  // namespace
}  // namespace cordis
