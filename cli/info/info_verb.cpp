// cli/info/info_verb.cpp
#include "cli/info/info_verb.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/exit_code.h"
#include "cli/info/session_info.h"
#include "cli/info/take_info.h"
#include "cli/take_file.h"
#include "node/terminal_text.h"

namespace cordis::cli {
namespace {

struct InfoWords {
  std::string subject;
  std::string topics;
  std::string domain;
  bool json = false;
};

/// A launch file names the session that it began; every other file should be a take.
bool is_session(const std::string& subject) {
  std::error_code ignored;
  if (subject.ends_with(".mcap") || subject.ends_with(".part")) return false;
  return subject.ends_with(".yaml") || !std::filesystem::exists(subject, ignored);
}

int info(const InfoWords& words) {
  if (is_session(words.subject)) {
    if (words.json) throw UsageError("--json is for takes; `cordis list --json` lists sessions");
    node::print_text(stdout, session_text(words.subject, words.topics, words.domain));
    return kSuccess;
  }
  if (!words.topics.empty() || !words.domain.empty())
    throw UsageError("TOPIC and --domain are for running sessions");
  const auto take = open_take("info", words.subject);
  node::print_text(stdout, words.json ? take_json(*take) : take_text(*take));
  return missed_in(*take).losses() > 0 ? kLoss : kSuccess;
}

}  // namespace

void add_info_verb(CommandLine& line) {
  auto words = std::make_shared<InfoWords>();
  Verb& verb = line.verb("info", "TAKE|SESSION [TOPIC] [options]",
                         "Say what a take holds, or what is on the topics of a session");
  verb.required_word("TAKE|SESSION", words->subject,
                     "An MCAP file, the name of a running session, or its launch file");
  verb.optional_word("TOPIC", words->topics, "Session: topics alone that match, as 'gesture/*'");
  verb.option("--domain", "N", words->domain,
              "Session: its DDS domain, when another user or host began it");
  verb.flag("--json", words->json, "Take: print one JSON object");
  verb.examples(
      "A take that was never closed, or is damaged, is read as far as its chunks are whole.\n"
      "The rate of a topic is its mean over the take.\n"
      "Keys of the JSON: take, size_bytes, library, whole, damage, duration_s, start_nsec,\n"
      "end_nsec, messages, and lists: topics (name, type, encoding, messages, rate_hz), chunks\n"
      "(compression, count, compressed_bytes, uncompressed_bytes), attachments (name,\n"
      "media_type, size_bytes); metadata holds the words of each name; missed counts messages "
      "that\n"
      "are not in it: dropped before the disk, lost on the way; replaced: of the lost ones, "
      "frames,\n"
      "descriptions and statuses that newer ones have replaced; and before: written before the\n"
      "recorder had found their writers.\n"
      "Exit code: 0 done, 1 no such session, 2 no take, or bad command line, 3 the take lacks\n"
      "messages that were dropped or lost, and not replaced.\n\n"
      "Examples:\n"
      "  cordis info take.mcap\n"
      "  cordis info take.mcap --json\n"
      "  cordis info plucked_string\n"
      "  cordis info plucked_string 'scene/*'\n");
  verb.action([words] { return info(*words); });
}

}  // namespace cordis::cli
