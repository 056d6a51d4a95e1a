// cli/record/record_verb.cpp
#include "cli/record/record_verb.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/progress_line.h"
#include "cli/session_end.h"
#include "cli/session_launch.h"
#include "cli/session_words.h"
#include "node/last_take.h"
#include "node/log.h"
#include "node/runtime_folder.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "record_node/idl/idl_parser.h"
#include "record_node/mcap/writer.h"
#include "record_node/plan_report.h"
#include "record_node/record_config.h"
#include "record_node/recorder.h"

namespace cordis::cli {
namespace {

constexpr auto kRecordProgress = std::chrono::milliseconds(250);
constexpr double kLongSilenceS = 2.0;  // processes find each other sooner

struct RecordWords {
  SessionWords target;
  std::string out;
  std::vector<std::string> topics;
  std::vector<std::string> excluded;
  std::vector<std::string> idl_files;
  std::string max_duration;
  std::string compression = "zstd";
};

record::RecorderConfig config_of(const RecordWords& words, const SessionAddress& address) {
  record::RecorderConfig config;
  config.domain = address.domain;
  config.session = address.session;
  config.network = address.network;
  config.security = security_for(address, node::Role::kRecorder);
  config.node = "cordis record";
  const auto packed = mcap::compression_named(words.compression);
  if (!packed)
    throw UsageError("--compression must be zstd, lz4 or none, got '" + words.compression + "'");
  config.compression = *packed;
  config.topics = words.topics;
  config.excluded = words.excluded;
  config.idl = record::read_idl_files(words.idl_files, {});
  config::Problems unread;  // a file that has errors by now explains nothing of the session
  const config::Launch launch = running_launch(address, unread);
  if (!launch.file.empty()) config.attached = record::files_of(launch);
  config.about = record::about_session(launch, config.attached);
  config.plan_command =
      record::plan_command(launch.file, {std::string("clock=") + config::clock_word(launch.clock)});
  return config;
}

/// Makes its folder. Says where the take goes when its name is taken.
std::filesystem::path take_of(const RecordWords& words, const SessionAddress& address) {
  const std::string name =
      address.session.empty() ? "domain-" + std::to_string(address.domain) : address.session;
  const std::filesystem::path wanted = record::wanted_take_path(
      words.out.empty() ? record::kUsualTake : words.out, name, std::filesystem::current_path());
  record::make_take_folder(wanted);
  const std::filesystem::path free = record::free_take_path(wanted);
  if (free != wanted)
    std::fprintf(stderr, "cordis record: %s\n", record::existing_take_text(wanted, free).c_str());
  return free;
}

std::string progress(const record::RecorderFigures& now, double mb_per_s) {
  return fmt::format("{:.1f} s  {} messages  {:.1f} MB  {:.2f} MB/s  queue {:.1f} MB  dropped {}",
                     now.seconds, now.messages, static_cast<double>(now.file_bytes) / 1e6, mb_per_s,
                     static_cast<double>(now.waiting_bytes) / 1e6, now.missed.dropped);
}

int record(const RecordWords& words) {
  std::optional<std::chrono::nanoseconds> longest;
  if (!words.max_duration.empty()) longest = parse_duration(words.max_duration);
  const SessionAddress address = words.target.address();
  SessionEnd end(address);
  record::RecorderConfig config = config_of(words, address);
  config.out = take_of(words, address);
  node::install_log("record");
  node::install_stop_signals();
  for (const auto& part : record::unfinished_takes(config.out.parent_path()))
    std::fprintf(stderr,
                 "cordis record: %s was never finished: `cordis recover` saves what is in it\n",
                 part.c_str());
  record::Recorder recorder(config);
  std::fprintf(stderr, "records into %s; Ctrl-C ends it\n", config.out.c_str());
  if (!address.session.empty())
    node::remember_take(node::runtime_folder(), address.session, config.out);
  ProgressLine line;
  record::RecorderFigures before;
  std::string mismatch;
  std::string unmatched;
  while (!node::wait_for_stop(kRecordProgress)) {
    const record::RecorderFigures now = recorder.figures();
    const double spent = now.seconds - before.seconds;
    const double grown =
        static_cast<double>(now.file_bytes) - static_cast<double>(before.file_bytes);
    line.show(progress(now, spent > 0.0 ? grown / spent / 1e6 : 0.0));
    before = now;
    if (const std::string found = recorder.mismatch(); found != mismatch) {
      mismatch = found;
      if (!found.empty()) spdlog::warn("{}", found);
    }
    if (unmatched.empty() && now.seconds > kLongSilenceS) {
      unmatched = recorder.unmatched();
      if (!unmatched.empty()) spdlog::warn("{}", unmatched);
    }
    const bool long_enough = longest && seconds_of(*longest) <= now.seconds;
    if (now.is_over || long_enough || !end.update().empty()) break;
  }
  line.end();
  if (!end.update().empty()) node::print_text(stderr, "cordis record: " + end.update() + "\n");
  const record::RecorderFigures done = recorder.close();
  const std::filesystem::path file = done.has_failed ? mcap::part_of(config.out) : config.out;
  std::printf("%s: %llu messages of %llu topics, %.1f MB in %.1f s\n", file.c_str(),
              static_cast<unsigned long long>(done.messages - done.missed.dropped),
              static_cast<unsigned long long>(done.topics),
              static_cast<double>(done.file_bytes) / 1e6, done.seconds);
  if (!done.problem.empty()) std::fprintf(stderr, "cordis record: %s\n", done.problem.c_str());
  for (const std::string& sentence : record::sentences_of(done.missed))
    std::fprintf(stderr, "cordis record: %s\n", sentence.c_str());
  if (done.has_failed) {
    std::fprintf(stderr, "cordis record: `cordis recover %s` saves what is in it\n", file.c_str());
    return kFailure;
  }
  if (unmatched.empty() && !recorder.unmatched().empty())
    std::fprintf(stderr, "cordis record: %s\n", recorder.unmatched().c_str());
  if (done.messages == 0) {
    std::fputs("cordis record: nothing was recorded\n", stderr);
    return kFailure;
  }
  return done.is_over || done.missed.losses() > 0 ? kLoss : kSuccess;
}

}  // namespace

void add_record_verb(CommandLine& line) {
  auto words = std::make_shared<RecordWords>();
  Verb& verb = line.verb("record", "FILE|SESSION [options]",
                         "Record the messages of a session into a file (MCAP)");
  verb.optional_word("FILE|SESSION", words->target.session,
                     "The launch file, or the name of the session");
  verb.option("-o,--out", "TAKE", words->out, "Where to (takes/{session}-{time}.mcap)");
  verb.list("--topics", "GLOB,...", words->topics, "These topics alone: 'scene/*'");
  verb.list("--exclude", "GLOB,...", words->excluded, "Not these topics");
  verb.list("--idl", "FILE,...", words->idl_files,
            "IDL files of types that Cordis does not have: the take explains them");
  verb.option("--max-duration", "TIME", words->max_duration, "End after so long: 10s, 5min");
  verb.option("--compression", "NAME", words->compression, "zstd, lz4 or none (zstd)");
  add_session_options(verb, words->target);
  verb.examples(
      "It records until Ctrl-C or the end of the session. Without a session, --domain N records\n"
      "all messages that programs of this host publish in that DDS domain, of whatever types,\n"
      "until Ctrl-C.\n"
      "No process waits for the recorder. Before a slow disk it drops frames first, and counts "
      "them.\n"
      "Exit code: 0 done, 1 failed or nothing recorded, 2 bad command line, 3 done with loss.\n\n"
      "Examples:\n"
      "  cordis record plucked_string\n"
      "  cordis record plucked_string -o take.mcap --topics 'gesture/*,scene/*' --max-duration "
      "60s\n"
      "  cordis record --domain 5 --idl msgs.idl\n");
  verb.action([words] { return record(*words); });
}

}  // namespace cordis::cli
