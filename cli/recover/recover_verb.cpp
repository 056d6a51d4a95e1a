// cli/recover/recover_verb.cpp
#include "cli/recover/recover_verb.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/exit_code.h"
#include "cli/table/output_file.h"
#include "cli/take_file.h"
#include "node/config/count_text.h"
#include "node/terminal_text.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/recover.h"

namespace cordis::cli {
namespace {

struct RecoverWords {
  std::string take;
  std::string output;
};

std::string recovery_text(const mcap::Recovery& recovery) {
  const std::string kept = config::count_text(recovery.statistics.message_count, "message") +
                           " in " + config::count_text(recovery.statistics.chunk_count, "chunk");
  if (recovery.was_whole) return fmt::format("{} is whole: {}\n", recovery.path.string(), kept);
  std::string text = fmt::format("{} is whole again: {}\n", recovery.path.string(), kept);
  if (!recovery.was_closed)
    text += "  its recorder did not close it: what was in the open chunk is not in the file\n";
  for (const mcap::Damage& damage : recovery.damages) {
    text += fmt::format("  byte {}, {}: {}{}\n", damage.offset, size_text(damage.length),
                        damage.what, damage.is_loss ? "" : " (nothing lost)");
  }
  if (recovery.was_closed && recovery.damages.empty() && recovery.rebuilt_count == 0)
    text += "  its summary or a CRC was wrong, and is written again (nothing lost)\n";
  if (recovery.rebuilt_count > 0)
    text += fmt::format("  indexes of the messages of {} written again\n",
                        config::count_text(recovery.rebuilt_count, "chunk"));
  return text;
}

void copy_bytes(std::ifstream& from, OutputFile& to) {
  std::vector<char> block(std::size_t{1} << 20);
  while (from.read(block.data(), static_cast<std::streamsize>(block.size())) || from.gcount() > 0)
    to.write({block.data(), static_cast<std::size_t>(from.gcount())});
  to.flush();
}

/// @throws UsageError when there cannot be a copy, std::runtime_error when it cannot be completed,
/// as on a full disk; then nothing is left of it.
void copy_take(const std::string& take, const std::filesystem::path& copy) {
  std::error_code error;
  if (std::filesystem::exists(copy, error))
    throw UsageError("cannot copy to " + copy.string() + ": it exists");
  std::ifstream from(take, std::ios::binary);
  if (!from) throw UsageError("cannot read " + take);
  OutputFile to(copy.string());
  try {
    copy_bytes(from, to);
    if (from.bad()) throw std::runtime_error("cannot read " + take + " to its end");
  } catch (const std::runtime_error&) {
    std::filesystem::remove(copy, error);
    throw;
  }
}

/// Removes a copy that cannot be recovered.
mcap::Recovery recover_or_leave_nothing(const std::filesystem::path& take, bool is_copy) {
  try {
    return mcap::recover(take);
  } catch (const mcap::FileError&) {
    if (is_copy) std::filesystem::remove(take);
    throw;
  }
}

int run(const RecoverWords& words) {
  std::filesystem::path take = words.take;
  std::error_code error;
  if (!std::filesystem::is_regular_file(take, error))
    throw UsageError("there is no file " + words.take);
  if (!words.output.empty()) {
    take = words.output == "-" ? "./-" : words.output;
    copy_take(words.take, take);
  }
  const mcap::Recovery recovery = recover_or_leave_nothing(take, /*is_copy=*/!words.output.empty());
  node::print_text(stdout, recovery_text(recovery));
  return recovery.has_loss() ? kLoss : kSuccess;
}

}  // namespace

void add_recover_verb(CommandLine& line) {
  auto words = std::make_shared<RecoverWords>();
  Verb& verb = line.verb("recover", "TAKE [options]", "Make a torn take whole, where it is");
  verb.required_word("TAKE", words->take, "A take; `take.mcap.part` becomes `take.mcap`");
  verb.option("-o,--output", "FILE", words->output, "Repair a copy, and leave the take as it is");
  verb.examples(
      "It keeps every whole chunk, cuts the torn end, lets readers skip what is damaged between\n"
      "chunks, and writes missing indexes and the summary again. A whole take stays as it is.\n"
      "Exit code: 0 nothing in the file was lost, 3 something was, 1 it cannot be recovered\n"
      "or the disk is full, 2 bad command line.\n\n"
      "Examples:\n"
      "  cordis recover take.mcap\n"
      "  cordis recover take.mcap --output repaired.mcap\n");
  verb.action([words] { return run(*words); });
}

}  // namespace cordis::cli
