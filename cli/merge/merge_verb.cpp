// cli/merge/merge_verb.cpp
#include "cli/merge/merge_verb.h"

#include <memory>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "cli/take_file.h"
#include "record_node/mcap/take_copy.h"

namespace cordis::cli {
namespace {

struct MergeWords {
  std::string first;
  std::vector<std::string> others;
  std::string output;
  std::string compression = "zstd";
};

int run(const MergeWords& words) {
  if (words.output.empty()) throw UsageError("--output is missing");
  if (words.others.empty()) throw UsageError("a second TAKE is missing");
  std::vector<std::unique_ptr<mcap::Reader>> takes;
  takes.push_back(open_take("merge", words.first));
  for (const std::string& file : words.others) takes.push_back(open_take("merge", file));
  std::vector<const mcap::Reader*> readers;
  bool is_whole = true;
  for (const auto& take : takes) {
    readers.push_back(take.get());
    is_whole = is_whole && take->is_whole();
  }
  const auto writer = make_take(words.output, words.compression);
  const std::vector<std::string> problems = mcap::merge(readers, *writer);
  finish_take("merge", *writer, problems);
  return is_whole && problems.empty() ? kSuccess : kLoss;
}

}  // namespace

void add_merge_verb(CommandLine& line) {
  auto words = std::make_shared<MergeWords>();
  Verb& verb =
      line.verb("merge", "TAKE TAKE... --output FILE [options]", "Write several takes into one");
  verb.required_word("TAKE", words->first, "A take: an MCAP file");
  verb.more_words("TAKE...", words->others, "The others");
  verb.option("-o,--output", "FILE", words->output, "The new take");
  verb.option("--compression", "NAME", words->compression,
              "Codec of the new take: none, lz4 or zstd");
  verb.examples(
      "Messages are ordered by the time at which they were received. Equal channels become one.\n"
      "Attachments and metadata of the same name and other contents get the name of their take\n"
      "before theirs.\n"
      "Exit code: 0 done, 3 done, but a take was damaged, 1 it could not be written, 2 no take,\n"
      "or bad command line.\n\n"
      "Examples:\n"
      "  cordis merge hands.mcap part.mcap --output both.mcap\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
