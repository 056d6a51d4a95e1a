// cli/cut/cut_verb.cpp
#include "cli/cut/cut_verb.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/duration.h"
#include "cli/exit_code.h"
#include "cli/take_file.h"
#include "record_node/mcap/take_copy.h"
#include "record_node/mcap/topic_glob.h"

namespace cordis::cli {
namespace {

struct CutWords {
  std::string take;
  std::string output;
  std::string start;
  std::string duration;
  std::vector<std::string> topics;
  std::string compression = "zstd";
};

bool has_topic(const mcap::Reader& take, const std::vector<std::string>& patterns) {
  const auto& channels = take.channels();
  return std::any_of(channels.begin(), channels.end(), [&patterns](const auto& entry) {
    return mcap::matches_topic(entry.second.topic, patterns);
  });
}

/// Warns of patterns that fit no topic. @throws UsageError when none fits any
void check_topics(const mcap::Reader& take, const std::vector<std::string>& patterns) {
  if (!has_topic(take, patterns) && !patterns.empty()) {
    std::string known;
    for (const auto& [id, channel] : take.channels())
      known += (known.empty() ? "" : ", ") + channel.topic;
    throw UsageError("no topic fits '" + patterns.front() + "'; the take has " +
                     (known.empty() ? "none" : known));
  }
  for (const std::string& pattern : patterns) {
    if (!has_topic(take, {pattern}))
      std::fprintf(stderr, "cordis cut: no topic fits '%s'\n", pattern.c_str());
  }
}

mcap::MessageFilter filter_of(const CutWords& words, const mcap::Reader& take) {
  mcap::MessageFilter filter;
  filter.topics = words.topics;
  check_topics(take, words.topics);
  const mcap::Statistics& statistics = take.statistics();
  filter.start_nsec = statistics.start_nsec;
  if (!words.start.empty()) filter.start_nsec += start_offset_in(take, words.start);
  if (!words.duration.empty()) {
    filter.end_nsec =
        filter.start_nsec + static_cast<std::uint64_t>(parse_duration(words.duration).count());
  }
  return filter;
}

int run(const CutWords& words) {
  if (words.output.empty()) throw UsageError("--output is missing");
  const auto take = open_take("cut", words.take);
  const mcap::MessageFilter filter = filter_of(words, *take);
  const auto writer = make_take(words.output, words.compression);
  const std::vector<std::string> problems = mcap::cut(*take, filter, *writer);
  finish_take("cut", *writer, problems);
  return take->is_whole() && problems.empty() ? kSuccess : kLoss;
}

}  // namespace

void add_cut_verb(CommandLine& line) {
  auto words = std::make_shared<CutWords>();
  Verb& verb = line.verb("cut", "TAKE --output FILE [options]", "Write a part of a take to a file");
  verb.required_word("TAKE", words->take, "A take: an MCAP file");
  verb.option("-o,--output", "FILE", words->output, "The new take");
  verb.option("--start-offset", "TIME", words->start, "Begin so long after its start");
  verb.option("--duration", "TIME", words->duration, "How much to keep [all that follows]");
  verb.list("--topics", "A,B,C", words->topics,
            "Topics to keep; patterns with * and ? are allowed [all]");
  verb.option("--compression", "NAME", words->compression,
              "Codec of the new take: none, lz4 or zstd");
  verb.examples(
      "Attachments and metadata are kept. Topics that a session keeps for late joiners begin\n"
      "with their last message before the cut.\n"
      "Exit code: 0 done, 3 done, but the take was damaged, 1 it could not be written, 2 no take,\n"
      "or bad command line.\n\n"
      "Examples:\n"
      "  cordis cut take.mcap --output part.mcap --start-offset 2s --duration 500ms\n"
      "  cordis cut take.mcap --output hands.mcap --topics 'gesture/*,device/description'\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
