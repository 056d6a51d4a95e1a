// tests/integration/record_play_test.cpp -- a session is recorded, played, and recorded again.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "idl/schema_text.h"
#include "record_node/mcap/reader.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

using test::ChildProcess;
using test::eventually;
using test::kPatience;

const std::string kCordis = std::string(CORDIS_PROGRAM_DIR) + "/cordis";
const std::string kLaunch = std::string(CORDIS_SOURCE_DIR) + "/launch_configs/plucked_string.yaml";

std::string domain_word() {
  return "domain=" + std::to_string(test::own_domain());
}

/// A folder of this test alone.
fs::path fresh_folder(const std::string& name) {
  const fs::path folder =
      fs::temp_directory_path() / ("cordis_" + name + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::vector<std::string> session_words(const fs::path& take) {
  return {kCordis,       "run",
          kLaunch,       "keyboard.driver=script",
          "--only",      "sim,keyboard,record",
          domain_word(), "--record",
          take.string(), "--duration",
          "4s"};
}

using Payloads = std::map<std::string, std::vector<std::string>>;

/// The payloads of each topic, in the order of their writers' numbers.
Payloads payloads_of(const fs::path& take) {
  const mcap::Reader reader(take);
  Payloads payloads;
  mcap::MessageCursor cursor = reader.messages();
  for (mcap::Message message; cursor.next(message);) {
    payloads[reader.channels().at(message.channel_id).topic].emplace_back(
        reinterpret_cast<const char*>(message.data.data()), message.data.size());
  }
  return payloads;
}

/// The take names versions, seeds, rates and the plan, and has one schema per type, with no more
/// than the type needs.
void expect_words_and_schemas(const mcap::Reader& take) {
  std::map<std::string, std::map<std::string, std::string>> words;
  for (const mcap::Metadata& metadata : take.metadata()) words[metadata.name] = metadata.values;
  EXPECT_EQ(words["cordis.session"]["clock"], "realtime");
  EXPECT_EQ(words["cordis.session"]["seed"], "1");
  EXPECT_FALSE(words["cordis.session"]["host"].empty());
  EXPECT_FALSE(words["cordis.session"]["cordis_version"].empty());
  EXPECT_EQ(words["cordis.scene"]["name"], "plucked_string");
  EXPECT_EQ(words["cordis.scene"]["gesture_rate_hz"], "1000");
  EXPECT_EQ(words["cordis.scene"]["frame_rate_hz"], "25");
  EXPECT_EQ(words["cordis.plan"]["step_rate_hz"], words["cordis.scene"]["step_rate_hz"]);
  EXPECT_FALSE(words["cordis.plan"]["integrator"].empty());
  EXPECT_FALSE(words["cordis.plan"]["hash_version"].empty());

  std::set<std::string> types;
  for (const auto& [id, schema] : take.schemas()) {
    EXPECT_TRUE(types.insert(schema.name).second) << schema.name << " has two schemas";
    EXPECT_EQ(schema.data, msg::schema_text_of(schema.name));
  }
  EXPECT_TRUE(types.contains("cordis::msg::NodeStatus"));
  EXPECT_GT(take.channels().size(), types.size());  // sim_node and device_node share a schema
}

/// The take holds what `cordis check` says of the session that it is of. On a machine too busy for
/// that, the log says that it does not.
void expect_plan(const mcap::Reader& take, const std::string& log) {
  ChildProcess check({kCordis, "check", "--plan", kLaunch, "keyboard.driver=script"});
  ASSERT_EQ(check.wait(kPatience), 0) << check.output();
  EXPECT_NE(check.output().find("integrator"), std::string::npos) << check.output();
  for (const mcap::Attachment& file : take.attachments()) {
    if (file.name != "plan.txt") continue;
    const std::string text(reinterpret_cast<const char*>(file.data.data()), file.data.size());
    EXPECT_EQ(text, check.output());
    return;
  }
  EXPECT_NE(log.find("the take lacks plan.txt"), std::string::npos) << log;
}

/// Samples of the force loop come to a recorder in batches, and are logged when they were sent. On a
/// machine that stood still they came too late for that.
void expect_even_loop(const mcap::Reader& take) {
  std::map<std::string, int> logged;
  std::map<std::string, int> logged_when_sent;
  mcap::MessageCursor cursor = take.messages();
  for (mcap::Message message; cursor.next(message);) {
    const std::string topic = take.channels().at(message.channel_id).topic;
    ++logged[topic];
    logged_when_sent[topic] += message.log_time_nsec == message.publish_time_nsec;
  }
  for (const char* topic : {"gesture/positions", "gesture/forces"}) {
    EXPECT_GT(logged[topic], 100) << topic;
    EXPECT_GT(logged_when_sent[topic], logged[topic] / 2) << topic;
  }
  EXPECT_EQ(logged_when_sent["scene/frame"], 0) << "a frame is logged when it came";
}

TEST(RecordPlay, GivesTheSamePayloadsWhenThePlayedSessionIsRecorded) {
  const fs::path folder = fresh_folder("record_play");
  const fs::path first = folder / "first.mcap";
  const fs::path second = folder / "second.mcap";
  ChildProcess session(session_words(first));
  ASSERT_EQ(session.wait(kPatience), 0) << session.output();
  const mcap::Reader take(first);
  EXPECT_TRUE(take.is_whole()) << take.damage();
  std::vector<std::string> attached;
  for (const mcap::Attachment& file : take.attachments()) attached.push_back(file.name);
  for (const char* file : {"plucked_string.yaml", "scenes/plucked_string.yaml"})
    EXPECT_NE(std::find(attached.begin(), attached.end(), file), attached.end()) << file;

  expect_words_and_schemas(take);
  expect_plan(take, session.output());
  expect_even_loop(take);

  const std::string domain = std::to_string(test::own_domain());
  ChildProcess recorder(
      {kCordis, "record", "played_again", "--domain", domain, "-o", second.string()});
  ASSERT_TRUE(recorder.wait_for_output("records into", kPatience));
  ChildProcess player({kCordis, "play", first.string(), "--session", "played_again", "--domain",
                       domain, "--wait-for-readers"});
  ASSERT_EQ(player.wait(kPatience), 0) << player.output();
  recorder.signal(SIGINT);
  const int ended = recorder.wait(kPatience);
  EXPECT_TRUE(ended == 0 || ended == 3) << recorder.output();

  const Payloads before = payloads_of(first);
  const Payloads after = payloads_of(second);
  for (const char* topic :
       {"scene/description", "device/description", "scene/signals", "scene/inputs"}) {
    ASSERT_TRUE(before.contains(topic)) << topic;
    ASSERT_TRUE(after.contains(topic)) << topic;
    EXPECT_EQ(before.at(topic), after.at(topic)) << topic;
  }
  // 3: what was equal is not all, for frames may be lost on the way.
  ChildProcess resim({kCordis, "resim", second.string()});
  const int compared = resim.wait(kPatience);
  EXPECT_TRUE(compared == 0 || compared == 3) << resim.output();
  // Best effort: each that came is one that was played, and few are lost.
  for (const char* topic : {"gesture/positions", "gesture/forces", "scene/frame"}) {
    const std::vector<std::string>& played = before.at(topic);
    const std::vector<std::string>& heard = after.at(topic);
    EXPECT_GT(heard.size(), played.size() / 2) << topic;
    std::size_t next = 0;
    for (const std::string& payload : heard) {
      while (next < played.size() && played[next] != payload) ++next;
      ASSERT_LT(next, played.size()) << topic << ": a payload that was not played, or out of order";
    }
  }
  fs::remove_all(folder);
}

TEST(RecordPlay, ARecorderThatJoinsInMidSessionHasWhatASessionKeepsForIt) {
  const fs::path folder = fresh_folder("record_late");
  ChildProcess session(
      {kCordis, "run", kLaunch, "keyboard.driver=script", "--only", "sim,keyboard", domain_word()});
  ASSERT_TRUE(session.wait_for_output("in DDS domain", kPatience));
  const auto record = [&](const std::string& name) {
    return std::make_unique<ChildProcess>(std::vector<std::string>{
        kCordis, "record", "plucked_string", "--domain", std::to_string(test::own_domain()), "-o",
        (folder / name).string()});
  };
  const auto wait_for_bytes = [&](const std::string& name, std::uintmax_t bytes) {
    return eventually([&] {
      std::error_code absent;
      const auto size = fs::file_size(folder / (name + ".part"), absent);
      return !absent && size > bytes;
    });
  };
  const auto early = record("early.mcap");
  ASSERT_TRUE(wait_for_bytes("early.mcap", 100'000)) << early->output();
  const auto late = record("late.mcap");
  ASSERT_TRUE(wait_for_bytes("late.mcap", 200'000)) << late->output();
  for (ChildProcess* recorder : {late.get(), early.get()}) {
    recorder->signal(SIGINT);
    const int code = recorder->wait(kPatience);
    EXPECT_TRUE(code == 0 || code == 3) << recorder->output();
  }
  session.signal(SIGINT);
  EXPECT_EQ(session.wait(kPatience), 0) << session.output();

  const mcap::Reader take(folder / "late.mcap");
  EXPECT_TRUE(take.is_whole()) << take.damage();
  expect_words_and_schemas(take);
  std::map<std::string, std::map<std::string, std::string>> words;
  for (const mcap::Metadata& metadata : take.metadata()) words[metadata.name] = metadata.values;
  EXPECT_GT(std::stoull(words["cordis.recording"]["messages_before"]), 0u);

  const Payloads all = payloads_of(folder / "early.mcap");
  const Payloads later = payloads_of(folder / "late.mcap");
  for (const char* topic : {"scene/description", "device/description"}) {
    ASSERT_TRUE(later.contains(topic)) << topic;
    EXPECT_EQ(later.at(topic), all.at(topic)) << topic;
  }
  // Every row from the first that it got on, until the first recorder joins its end.
  const std::vector<std::string>& rows = all.at("scene/signals");
  const std::vector<std::string>& later_rows = later.at("scene/signals");
  const auto first = std::ranges::find(rows, later_rows.front());
  EXPECT_GT(first - rows.begin(), 0);
  ASSERT_GE(rows.end() - first, std::ssize(later_rows));
  EXPECT_TRUE(std::equal(later_rows.begin(), later_rows.end(), first));

  // 3: on a busy machine it joins after the inputs that are kept.
  ChildProcess resim({kCordis, "resim", (folder / "late.mcap").string()});
  const int compared = resim.wait(kPatience);
  EXPECT_TRUE(compared == 3 ||
              (compared == 0 && resim.output().find("hash for hash") != std::string::npos))
      << resim.output();
  fs::remove_all(folder);
}

TEST(RecordPlay, ARecorderSaysWhatItHasWhereTheDiskIsFull) {
  const fs::path folder = fresh_folder("record_full");
  const fs::path take = folder / "take.mcap";
  const fs::path summary = folder / "summary.json";
  std::string command = "trap '' XFSZ; ulimit -f 300; exec";  // a file may have 300 kB
  for (const std::string& word : session_words(take)) command += " '" + word + "'";
  ChildProcess session({"/bin/bash", "-c", command + " --summary '" + summary.string() + "'"});
  EXPECT_EQ(session.wait(kPatience), 1) << "--record has no whole take";
  std::string said;
  std::getline(std::ifstream(summary), said, '\0');
  EXPECT_NE(said.find("\"complete\": false"), std::string::npos) << said;
  const mcap::Reader reader(take);
  EXPECT_TRUE(reader.is_whole()) << reader.damage();
  const std::string stored = std::to_string(reader.statistics().message_count);
  for (const std::string& sentence : {"there is no room for more of " + take.string(),
                                      take.string() + ": " + stored + " messages of ",
                                      std::string(" before a slow or full disk, 0 on the way")})
    EXPECT_NE(session.output().find(sentence), std::string::npos) << session.output();
  std::smatch lost;
  const std::string output = session.output();
  ASSERT_TRUE(std::regex_search(output, lost, std::regex(R"((\d+) messages lost: )"))) << output;
  std::smatch row;
  ASSERT_TRUE(std::regex_search(output, row, std::regex(R"(\nrecord +- +- +- +(\d+) )")) ||
              std::regex_search(output, row, std::regex(R"(\nrecord +\S+ +- +- +(\d+) )")))
      << output;
  EXPECT_EQ(row[1], lost[1]) << "the table has the last figures";
  fs::remove_all(folder);
}

TEST(RecordPlay, KeepsWhatWasWrittenBeforeARecorderIsKilled) {
  const fs::path folder = fresh_folder("record_killed");
  const fs::path take = folder / "take.mcap";
  const fs::path part = take.string() + ".part";
  std::vector<std::string> words = session_words(take);
  words.back() = "1h";
  ChildProcess session(words);
  ASSERT_TRUE(eventually([&] { return fs::exists(part) && fs::file_size(part) > 200'000; }));
  kill(test::process_of(session, "record"), SIGKILL);
  // The launcher starts it again: into another file, beside the unfinished one.
  ASSERT_TRUE(session.wait_for_output("was never finished", kPatience));
  const fs::path again = folder / "take-2.mcap.part";
  ASSERT_TRUE(eventually([&] { return fs::exists(again) && fs::file_size(again) > 50'000; }));
  session.signal(SIGINT);
  EXPECT_EQ(session.wait(kPatience), 0) << session.output();

  const Payloads kept = payloads_of(part);
  EXPECT_GT(kept.at("gesture/positions").size(), 100u);
  EXPECT_TRUE(mcap::Reader(folder / "take-2.mcap").is_whole());
  fs::remove_all(folder);
}

TEST(RecordPlay, DoesNotBeginASessionWhoseTakeHasNoPlace) {
  const fs::path folder = fresh_folder("record_nowhere");
  std::ofstream(folder / "file") << "no folder";
  const std::string launch = (folder / "launch.yaml").string();
  std::ofstream(launch) << "cordis: 1\n"
                        << "session: nowhere\n"
                        << "record: {out: file/take.mcap}\n"
                        << "nodes: {sim: {node: sim_node, scene: "
                        << CORDIS_SOURCE_DIR "/launch_configs/scenes/hanging_chain.yaml}}\n";
  ChildProcess named({kCordis, "run", launch, domain_word(), "--duration", "1s"});
  EXPECT_EQ(named.wait(kPatience), 2) << named.output();
  EXPECT_NE(named.output().find("launch.yaml:3:15: error: no take can be made in "),
            std::string::npos)
      << named.output();
  EXPECT_EQ(named.output().find("session 'nowhere' in DDS domain"), std::string::npos);

  ChildProcess braces({kCordis, "run", launch, domain_word(), "--duration", "1s", "--record",
                       (folder / "{hour}.mcap").string()});
  EXPECT_EQ(braces.wait(kPatience), 2) << braces.output();
  EXPECT_NE(braces.output().find("{session} and {time} alone, not '{hour}'"), std::string::npos);

  // A folder that is missing is made, but not before the session begins.
  const fs::path new_folder = folder / "new" / "takes";
  ChildProcess good({kCordis, "run", launch, domain_word(), "--duration", "1s", "--record",
                     (new_folder / "take.mcap").string()});
  EXPECT_EQ(good.wait(kPatience), 0) << good.output();
  EXPECT_TRUE(mcap::Reader(new_folder / "take.mcap").is_whole());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 3);
  fs::remove_all(folder);
}

TEST(RecordPlay, SaysWhereTheTakeGoesWhenItsNameIsTaken) {
  const fs::path folder = fresh_folder("record_twice");
  const std::string take = (folder / "take.mcap").string();
  std::ofstream(take) << "of another day";
  const auto record = [&] {
    ChildProcess run({kCordis, "run", kLaunch, domain_word(), "--only", "sim,record", "--record",
                      take, "--duration", "1s"});
    EXPECT_EQ(run.wait(kPatience), 0) << run.output();
    return run.output();
  };
  const std::string second = (folder / "take-2.mcap").string();
  const std::string third = (folder / "take-3.mcap").string();
  for (const std::string& file : {second, third}) {
    const std::string said = record();
    EXPECT_NE(said.find("cordis | " + take + " exists already: the take goes to " + file + "\n"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("\nrecord: " + file + ", "), std::string::npos) << said;
    EXPECT_TRUE(mcap::Reader(file).is_whole());
  }
  std::string kept;
  std::getline(std::ifstream(take), kept);
  EXPECT_EQ(kept, "of another day");
  fs::remove_all(folder);
}

TEST(RecordPlay, ClosesTheTakeWhenTheLauncherIsKilled) {
  const fs::path folder = fresh_folder("orphan");
  const std::string take = (folder / "take.mcap").string();
  ChildProcess run(
      {kCordis, "run", kLaunch, domain_word(), "--only", "sim,record", "--record", take});
  ASSERT_TRUE(eventually([&] {  // its scene plays
    return fs::exists(take + ".part") && fs::file_size(take + ".part") > 20'000;
  })) << run.output();

  run.signal(SIGKILL);

  EXPECT_EQ(run.wait(kPatience), 128 + SIGKILL);
  ASSERT_TRUE(eventually([&] { return fs::exists(take); }));
  EXPECT_TRUE(mcap::Reader(take).is_whole());
  fs::remove_all(folder);
}

TEST(RecordPlay, RefusesWhatIsNoTakeInOneSentence) {
  ChildProcess player({kCordis, "play", kLaunch});
  EXPECT_EQ(player.wait(kPatience), 2) << player.output();
  ChildProcess missing({kCordis, "play", "/nowhere/take.mcap"});
  EXPECT_EQ(missing.wait(kPatience), 2) << missing.output();
}

}  // namespace
}  // namespace cordis
