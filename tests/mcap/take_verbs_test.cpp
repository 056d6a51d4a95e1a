// tests/mcap/take_verbs_test.cpp -- the verbs on takes, as a person types them.
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/verbs.h"
#include "tests/cli/captured_run.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"
#include "tests/support/small_disk.h"

namespace cordis::cli {
namespace {

struct Answer {
  int code = 0;
  std::string out;
  std::string error;
};

Answer cordis(const std::vector<std::string>& words) {
  CommandLine line("cordis", "summary", "1.2.3");
  add_verbs(line);
  Answer answer;
  answer.code = run_captured(line, words, answer.out, answer.error);
  return answer;
}

class TakeVerbs : public ::testing::Test {
 protected:
  TakeVerbs() {
    std::mt19937 random(11);
    mcap::WriterConfig config;
    config.chunk_bytes = 4000;
    take_ = mcap::write_random_take(file_, random, config, 300);
  }
  /// Cuts the file of the take.
  void tear() { std::filesystem::resize_file(file_, std::filesystem::file_size(file_) * 6 / 10); }

  mcap::TakeFolder folder_;
  const std::string file_ = folder_ / "take.mcap";
  const std::string output_ = folder_ / "output.mcap";
  mcap::RandomTake take_;
};

TEST_F(TakeVerbs, InfoSaysWhatATakeHolds) {
  const Answer text = cordis({"info", file_});
  EXPECT_EQ(text.code, 0);
  EXPECT_EQ(text.error, "");
  for (const char* word :
       {"messages     300", "duration", "scene.yaml", "cordis.session", "topic/0", "zstd"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << "\n" << text.out;

  const auto json = nlohmann::json::parse(cordis({"info", file_, "--json"}).out);
  EXPECT_EQ(json["messages"], 300);
  EXPECT_EQ(json["whole"], true);
  const auto sorted = take_.by_time();
  const std::uint64_t span = sorted.back().log_time_nsec - sorted.front().log_time_nsec;
  EXPECT_DOUBLE_EQ(json["duration_s"], 1e-9 * static_cast<double>(span));
  std::uint64_t count = 0;
  for (const auto& topic : json["topics"]) count += topic["messages"].get<std::uint64_t>();
  EXPECT_EQ(count, 300u);
  EXPECT_EQ(json["topics"].size(), take_.channels.size());
  EXPECT_EQ(json["attachments"][0]["size_bytes"], take_.attachment.size());
}

TEST_F(TakeVerbs, InfoEndsWithLossWhereTheRecorderMissedMessages) {
  const auto info_of = [this](const std::string& lost, const std::string& before) {
    const std::string file = folder_ / ("lost_" + lost + "_before_" + before + ".mcap");
    mcap::Writer writer(file);
    EXPECT_EQ(writer.add_metadata(
                  {"cordis.recording", {{"messages_lost", lost}, {"messages_before", before}}}),
              mcap::WriteStatus::kOk);
    EXPECT_EQ(writer.close(), mcap::WriteStatus::kOk);
    return cordis({"info", file});
  };
  const Answer lossy = info_of("12", "0");
  EXPECT_EQ(lossy.code, 3);
  EXPECT_NE(lossy.out.find("12 messages lost on the way\n"), std::string::npos) << lossy.out;
  const Answer late = info_of("0", "7");
  EXPECT_EQ(late.code, 0);
  EXPECT_NE(late.out.find("7 messages written before the recorder had found their writers\n"),
            std::string::npos)
      << late.out;
}

TEST_F(TakeVerbs, ATornTakeIsReadAndSaidToBeTorn) {
  tear();

  const Answer info = cordis({"info", file_});
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.error.find("is damaged"), std::string::npos) << info.error;
  const Answer check = cordis({"check", file_});
  EXPECT_EQ(check.code, 2);
  EXPECT_NE(check.out.find("byte "), std::string::npos) << check.out;
  EXPECT_EQ(cordis({"cut", file_, "--output", output_}).code, 3);
  EXPECT_EQ(cordis({"check", output_}).code, 0);
}

TEST_F(TakeVerbs, RecoverRepairsInPlaceOrACopy) {
  EXPECT_EQ(cordis({"recover", file_}).code, 0);
  tear();
  const auto torn = mcap::contents_of(file_);

  EXPECT_EQ(cordis({"recover", file_, "--output", output_}).code, 3);
  EXPECT_EQ(mcap::contents_of(file_), torn);
  EXPECT_EQ(cordis({"recover", file_}).code, 3);
  EXPECT_EQ(mcap::contents_of(file_), mcap::contents_of(output_));
  EXPECT_EQ(cordis({"check", file_}).code, 0);
  EXPECT_EQ(cordis({"recover", file_}).code, 0);
}

TEST_F(TakeVerbs, RecoverWritesADamagedSummaryAgain) {
  const auto whole = mcap::contents_of(file_);
  auto damaged = whole;
  damaged[damaged.size() - 100] = static_cast<char>(~damaged[damaged.size() - 100]);
  mcap::write_file(file_, damaged);

  const Answer answer = cordis({"recover", file_});

  EXPECT_EQ(answer.code, 0);
  EXPECT_NE(answer.out.find("written again"), std::string::npos) << answer.out;
  EXPECT_EQ(mcap::contents_of(file_), whole);
}

/// A take of one message of each of three topics: lab/count with its schema, lab/bare without, and
/// one of another encoding.
std::string write_lab_take(const std::string& file) {
  mcap::Writer writer(file);
  const std::uint16_t schema = writer.add_schema(
      {0, "lab::Count", "omgidl", "module lab { struct Count { unsigned long number; }; };"});
  const std::uint16_t count = writer.add_channel({0, schema, "lab/count", "cdr", {}});
  const std::uint16_t bare =
      writer.add_channel({0, 0, "lab/bare", "cdr", {{"type", "lab::Count"}}});
  const std::uint16_t text = writer.add_channel({0, 0, "lab/\"text\"", "json", {}});
  const std::vector<std::byte> payload{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0},
                                       std::byte{7}, std::byte{0}, std::byte{0}, std::byte{0}};
  EXPECT_EQ(writer.write({count, 5, 2'000'000'000, 1'500'000'000, payload}),
            mcap::WriteStatus::kOk);
  EXPECT_EQ(writer.write({bare, 6, 3'000'000'000, 2'500'000'000, payload}), mcap::WriteStatus::kOk);
  EXPECT_EQ(writer.write({text, 7, 4'000'000'000, 3'500'000'000, payload}), mcap::WriteStatus::kOk);
  EXPECT_EQ(writer.close(), mcap::WriteStatus::kOk);
  return file;
}

TEST_F(TakeVerbs, EchoPrintsMessagesByTheTypesThatTheTakeDescribes) {
  const std::string lab = write_lab_take(folder_ / "lab.mcap");

  const Answer yaml = cordis({"echo", lab, "lab/count"});
  EXPECT_EQ(yaml.code, 0) << yaml.error;
  EXPECT_EQ(yaml.out,
            R"(topic: lab/count
time_s: 1.500000000
sequence: 5
message:
  number: 7
---
)");
  EXPECT_EQ(yaml.error, "");
  const Answer line = cordis({"echo", lab, "lab/c*", "--format", "ndjson"});
  EXPECT_EQ(line.out,
            "{\"topic\":\"lab/count\",\"time_s\":1.500000000,\"sequence\":5,"
            "\"message\":{\"number\":7}}\n");
  const Answer cells = cordis({"echo", lab, "lab/count", "--format", "csv"});
  EXPECT_EQ(cells.out, "time_s,number\n1.500000000,7\n");
}

TEST_F(TakeVerbs, EchoSaysWhatItCannotPrintAndTakesTypesFromAFile) {
  const std::string lab = write_lab_take(folder_ / "lab.mcap");
  const std::string idl = folder_ / "lab.idl";
  const std::string text = "module lab { struct Count { unsigned long number; }; };";
  mcap::write_file(idl, {text.begin(), text.end()});

  const Answer all = cordis({"echo", lab});
  EXPECT_EQ(all.code, 3);
  EXPECT_NE(all.error.find("lab/bare: the type lab::Count is not known: name a file that defines "
                           "it with --idl\n"),
            std::string::npos)
      << all.error;
  EXPECT_NE(all.error.find("2 messages left out\n"), std::string::npos) << all.error;
  EXPECT_EQ(cordis({"echo", lab, "lab/bare"}).code, 1);
  const Answer named = cordis({"echo", lab, "lab/bare", "--idl", idl});
  EXPECT_EQ(named.code, 0) << named.error;
  EXPECT_NE(named.out.find("number: 7"), std::string::npos) << named.out;
}

TEST_F(TakeVerbs, EchoEndsAfterItsCountAndReadsATornTake) {
  const std::string lab = folder_ / "many.mcap";
  {
    mcap::WriterConfig config;
    config.chunk_bytes = 200;
    mcap::Writer writer(lab, config);
    const std::uint16_t schema = writer.add_schema(
        {0, "lab::Count", "omgidl", "module lab { struct Count { unsigned long number; }; };"});
    const std::uint16_t channel = writer.add_channel({0, schema, "lab/count", "cdr", {}});
    for (std::uint32_t i = 0; i < 40; ++i) {
      std::vector<std::byte> payload(8);
      payload[1] = std::byte{1};
      payload[4] = static_cast<std::byte>(i);
      EXPECT_EQ(writer.write({channel, i, i, i, payload}), mcap::WriteStatus::kOk);
    }
  }
  const auto lines = [](const Answer& answer) {
    return std::count(answer.out.begin(), answer.out.end(), '\n');
  };
  const Answer three = cordis({"echo", lab, "lab/count", "-n", "3", "--format", "ndjson"});
  EXPECT_EQ(three.code, 0) << three.error;
  EXPECT_EQ(lines(three), 3);
  EXPECT_EQ(lines(cordis({"echo", lab, "--format", "ndjson"})), 40);
  std::filesystem::resize_file(lab, std::filesystem::file_size(lab) / 2);
  const Answer torn = cordis({"echo", lab, "--format", "ndjson"});
  EXPECT_EQ(torn.code, 3);
  EXPECT_NE(torn.error.find("is damaged"), std::string::npos) << torn.error;
  EXPECT_GT(lines(torn), 0);
  EXPECT_LT(lines(torn), 40);
}

TEST_F(TakeVerbs, RecoverLeavesNothingOnAFullDiskAndSaysSo) {
  tear();
  Answer answer;
  {
    const test::SmallDisk disk(std::filesystem::file_size(file_) / 2);
    answer = cordis({"recover", file_, "-o", output_});
  }
  EXPECT_EQ(answer.code, 1);
  EXPECT_EQ(answer.error, "cordis recover: cannot write '" + output_ + "': File too large\n");
  EXPECT_FALSE(std::filesystem::exists(output_));
  EXPECT_EQ(cordis({"recover", file_, "-o", file_}).code, 2);
}

TEST_F(TakeVerbs, MistakesEndInOneSentenceAndChangeNothing) {
  const auto before = mcap::contents_of(file_);
  mcap::write_file(folder_ / "text.mcap", {'h', 'i'});
  const std::string absent = folder_ / "absent.mcap";
  const std::string text = folder_ / "text.mcap";
  const std::vector<std::pair<std::vector<std::string>, int>> mistakes{
      {{"info"}, 2},
      {{"info", absent}, 2},
      {{"info", text}, 2},
      {{"info", "."}, 2},
      {{"check", text}, 2},
      {{"echo", absent}, 2},
      {{"echo", text}, 2},
      {{"echo", file_, "nothing"}, 2},
      {{"echo", file_, "--format", "csv"}, 2},
      {{"echo", file_, "--format", "xml"}, 2},
      {{"echo", file_, "--domain", "3"}, 2},
      {{"recover", absent}, 2},
      {{"recover", text}, 1},
      {{"recover", text, "--output", output_}, 1},
      {{"recover", file_, "--output", file_}, 2},
      {{"cut", file_}, 2},
      {{"cut", file_, "--output", file_}, 2},
      {{"cut", file_, "--output", output_, "--topics", "nothing"}, 2},
      {{"cut", file_, "--output", output_, "--start-offset", "2h"}, 2},
      {{"cut", file_, "--output", output_, "--start-offset", "2"}, 2},
      {{"cut", file_, "--output", output_, "--compression", "gzip"}, 2},
      {{"cut", file_, "--output", "/absent/folder/take.mcap"}, 1},
      {{"merge", file_, "--output", output_}, 2},
      {{"merge", file_, absent, "--output", output_}, 2},
      {{"merge", file_, file_}, 2},
  };
  for (const auto& [words, code] : mistakes) {
    const Answer answer = cordis(words);
    std::string line;
    for (const std::string& word : words) line += word + " ";
    EXPECT_EQ(answer.code, code) << line << answer.error;
    EXPECT_EQ(std::count(answer.error.begin(), answer.error.end(), '\n'), 1)
        << line << answer.error;
    EXPECT_FALSE(std::filesystem::exists(output_)) << line;
  }
  EXPECT_EQ(mcap::contents_of(file_), before);
}

TEST_F(TakeVerbs, CutAndMergeGiveBackTheWhole) {
  const std::string rest = folder_ / "rest.mcap";
  const std::string both = folder_ / "both.mcap";
  EXPECT_EQ(cordis({"cut", file_, "-o", output_, "--topics", "topic/0"}).code, 0);
  EXPECT_EQ(cordis({"cut", file_, "-o", rest, "--topics", "topic/[1-9]*,absent"}).code,
            take_.channels.size() > 1 ? 0 : 2);
  ASSERT_GT(take_.channels.size(), 1u);
  EXPECT_EQ(cordis({"merge", output_, rest, "-o", both, "--compression", "lz4"}).code, 0);
  const auto json = nlohmann::json::parse(cordis({"info", both, "--json"}).out);
  EXPECT_EQ(json["messages"], 300);
  EXPECT_EQ(json["attachments"].size(), 1u);
  EXPECT_EQ(json["chunks"][0]["compression"], "lz4");
}

}  // namespace
}  // namespace cordis::cli
