// tests/record/ask_test.cpp -- the verbs that ask a running session, and how they end.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record_node/mcap/reader.h"
#include "tests/record/count_take.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"

namespace cordis {
namespace {

using test::ChildProcess;
using test::kPatience;

const std::string kAsked = std::string(CORDIS_PROGRAM_DIR) + "/cordis";

/// A session that counts, and questions to it as a shell puts them.
class Ask : public ::testing::Test {
 protected:
  Ask() {
    test::write_count_take(take_);
    std::ofstream(idl_) << test::kCountIdl;
    played_.emplace(std::vector<std::string>{kAsked, "play", take_, "--loop", "--session", name_,
                                             "--domain", domain_});
    EXPECT_TRUE(played_->wait_for_output("session '" + name_ + "'", kPatience));
  }
  ~Ask() override {
    played_->signal(SIGINT);
    EXPECT_EQ(played_->wait(kPatience), 0) << played_->output();
  }

  /// Ends with `code`, and says so much.
  void ends(const std::string& question, int code, const std::string& says) const {
    ChildProcess shell(
        {"/bin/bash", "-c", "set -o pipefail; PATH=" CORDIS_PROGRAM_DIR ":$PATH; " + question});
    EXPECT_EQ(shell.wait(kPatience), code) << question << "\n" << shell.output();
    EXPECT_NE(shell.output().find(says), std::string::npos) << question << "\n" << shell.output();
  }

  mcap::TakeFolder folder_;
  const std::string take_ = folder_ / "take.mcap";
  const std::string idl_ = folder_ / "count.idl";
  const std::string domain_ = std::to_string(test::own_domain());
  const std::string name_ = "asked_" + domain_;  // others may run such tests beside this one
  std::optional<ChildProcess> played_;
};

TEST_F(Ask, FindsTheSessionByItsName) {
  ends("cordis list", 0, name_);
  ends("cordis list --json", 0, "\"session\": \"" + name_ + "\"");
  ends("cordis list --domain 9", 0, "no session runs in domain 9");  // no test has it
  ends("cordis info " + name_ + " lab/count", 0, "lab::Count");
  ends("cordis info " + name_ + " --domain " + domain_, 0, "in DDS domain " + domain_);
  ends("cordis echo " + name_ + " lab/count -n 2 --idl " + idl_, 0, "number: ");
  ends("cordis hz " + name_ + " --duration 500ms", 0, "lab/count");
}

/// The row of a topic in the last table of `cordis hz`.
struct TrafficRow {
  double rate_hz = 0.0;
  double min_msec = 0.0;
  double max_msec = 0.0;
  double kilobytes_per_s = 0.0;
  int missing = -1;
};

TrafficRow last_row_of(const std::string& output, const std::string& topic) {
  TrafficRow row;
  const std::size_t begin = output.rfind("\n" + topic + " ");
  if (begin == std::string::npos || output.find('\n', begin + 1) == std::string::npos) return row;
  std::istringstream words(output.substr(begin + 1 + topic.size()));
  words >> row.rate_hz >> row.min_msec >> row.max_msec >> row.kilobytes_per_s >> row.missing;
  return row;
}

/// The take has 40 messages of 8 bytes, 20 ms apart, and begins again 0 to 20 ms after the last.
TEST_F(Ask, MeasuresRateIntervalsAndBytesOfATopic) {
  ChildProcess hz({kAsked, "hz", name_, "lab/count"});
  TrafficRow row;
  EXPECT_TRUE(test::eventually([&] {
    row = last_row_of(hz.output(), "lab/count");
    return row.rate_hz > 47.0 && row.rate_hz < 54.0 && row.min_msec < 20.5 && row.max_msec > 19.5 &&
           row.max_msec < 80.0;
  })) << hz.output();
  EXPECT_NEAR(row.kilobytes_per_s, 8e-3 * row.rate_hz, 0.051) << "it is rounded to 0.1";
  EXPECT_EQ(row.missing, 0) << hz.output();
  hz.signal(SIGINT);
  EXPECT_EQ(hz.wait(kPatience), 0) << hz.output();
}

TEST_F(Ask, SaysWhichWordIsWrong) {
  for (const std::string verb :
       {"info unheard_of", "echo unheard_of", "hz unheard_of", "get unheard_of a.b"})
    ends("cordis " + verb, 1, "no session 'unheard_of' runs on this host");
  ends("cordis info " + name_ + " nothing", 1, "no process writes 'nothing'");
  ends("cordis hz " + name_ + " nothing --duration 200ms", 1,
       "no message has come on 'nothing'; `cordis info " + name_ + "` lists the topics");
  ends("cordis get " + name_ + " finger.stiffness_n_per_m", 2,
       "a take is played: it has no parameters to ask for");
  ends("cordis echo", 2, "which session?");
  ends("cordis echo " + name_ + " -n 0", 2, "-n must be a whole number");
  ends("cordis info " + name_ + " --json", 2, "--json is for takes");

  ends("cordis echo " + name_ + " nothing -n 1 --timeout 300ms", 1,
       "no message has come on 'nothing'; `cordis info " + name_ +
           "` lists the topics (--timeout 300ms)");
  ends("cordis echo " + name_ + " lab/count -n 3 --timeout 100s --idl " + idl_, 0, "count");
  ends("cordis echo " + name_ + " lab/count -n 3 --timeout 300ms", 1,
       "no message was printed for 300ms");
  ends("cordis echo " + take_ + " --timeout 1s", 2, "--timeout are for running sessions");
  for (const std::string verb : {"hz ", "get ", "record ", "ctl "})
    ends("cordis " + verb + take_ + (verb == "ctl " ? " pause" : ""), 2,
         "'" + take_ + "' is a take: name a session, or its launch file");

  ChildProcess echo({kAsked, "echo", name_, "nothing"});
  EXPECT_TRUE(echo.wait_for_output("no message has come on 'nothing'", kPatience));
  echo.signal(SIGINT);
  EXPECT_EQ(echo.wait(kPatience), 0) << echo.output();
}

TEST_F(Ask, NamesTheLastTakeOfASessionThatHasEnded) {
  const std::string take = folder_ / "copy.mcap";
  for (const std::string& file : {take, (folder_ / "copy-2.mcap").string()}) {
    ChildProcess recorder({kAsked, "record", name_, "-o", take});
    ASSERT_TRUE(recorder.wait_for_output("records into " + file, kPatience));
    if (file != take) {
      EXPECT_NE(recorder.output().find(take + " exists already: the take goes to " + file),
                std::string::npos)
          << recorder.output();
    }
    recorder.signal(SIGINT);
    EXPECT_NE(recorder.wait(kPatience), -1) << recorder.output();
  }
  ChildProcess other({kAsked, "play", take_, "--start-paused", "--session", name_ + "_other",
                      "--domain", domain_});
  ASSERT_TRUE(other.wait_for_output("session '" + name_, kPatience));
  other.signal(SIGINT);
  EXPECT_EQ(other.wait(kPatience), 0) << other.output();
  played_->signal(SIGINT);
  EXPECT_EQ(played_->wait(kPatience), 0) << played_->output();

  for (const std::string verb : {"info ", "echo ", "hz ", "record "}) {
    ends("cordis " + verb + name_, 1,
         "no session '" + name_ +
             "' runs on this host: start it with `cordis run`, or name its "
             "--domain; its last take is " +
             (folder_ / "copy-2.mcap").string() + "\n");
    ends("cordis " + verb + name_ + "_other", 1, "or name its --domain\n");
  }
}

TEST_F(Ask, RecordsTheTopicsThatAreWantedAndNotExcluded) {
  const auto topics_with = [this](const std::vector<std::string>& choice) {
    const std::string take = folder_ / "chosen.mcap";
    std::filesystem::remove(take);
    std::vector<std::string> words{kAsked, "record", name_, "-o", take, "--max-duration", "1s"};
    words.insert(words.end(), choice.begin(), choice.end());
    ChildProcess recorder(words);
    EXPECT_NE(recorder.wait(kPatience), -1) << recorder.output();
    std::set<std::string> topics;
    const mcap::Reader reader(take);
    for (const auto& [id, channel] : reader.channels()) topics.insert(channel.topic);
    return topics;
  };
  EXPECT_FALSE(topics_with({"--exclude", "lab/*"}).contains("lab/count"));
  EXPECT_FALSE(topics_with({"--topics", "node/*"}).contains("lab/count"));
  const std::set<std::string> count{"lab/count"};
  EXPECT_TRUE(test::eventually([&] { return topics_with({"--topics", "lab/*"}) == count; }));
}

TEST_F(Ask, SaysThatNoTopicFitsAndThatNothingWasRecorded) {
  const std::string out = (folder_ / "none.mcap").string();
  const std::string record = "cordis record " + name_ + " --max-duration 3s -o ";
  ends(record + out + " --topics nosuch", 1, "no topic fits 'nosuch'; there are ");
  ends(record + out + " --topics nosuch", 1, "lab/count");
  ends(record + out + " --topics nosuch", 1, "nothing was recorded");
  ends(record + out + " --topics 'nosuch,lab/*'", 0, "no topic fits 'nosuch'; there are ");
}

TEST_F(Ask, EndsWithoutAWordWhenItsReaderHasGone) {
  for (const std::string& question :
       {"echo " + name_ + " lab/count --idl " + idl_, "hz " + name_, "info " + name_}) {
    ChildProcess shell(
        {"/bin/bash", "-c",
         "set -o pipefail; " + kAsked + " " + question + " | head -c 1 > /dev/null"});
    EXPECT_EQ(shell.wait(kPatience), 0) << shell.output();
    EXPECT_EQ(shell.output(), "") << question;
  }
}

TEST_F(Ask, SaysWhenItsOutputFindsNoRoom) {
  ends("cordis echo " + name_ + " lab/count --idl " + idl_ + " > /dev/full", 1,
       "cannot write the output: No space left on device");
  ends("cordis hz " + name_ + " > /dev/full", 1, "No space left on device");
}

}  // namespace
}  // namespace cordis
