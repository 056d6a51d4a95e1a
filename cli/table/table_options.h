// cli/table/table_options.h -- the files that `cordis simulate` and `cordis export` write.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/table/column.h"
#include "cli/table/table_file.h"

namespace cordis::cli {

/// Which files a person asks for. A path is empty when the file is not wanted; `-` is stdout.
struct TableOptions {
  std::string csv_file;
  std::string npz_file;
  std::string wav_file;
  std::string events_file;
  std::vector<std::string> mats;  ///< words that pick MATs, for columns of their positions
  std::string every = "tick";     ///< which rows; each verb has its own words beside `tick`

  bool has_table() const noexcept { return !csv_file.empty() || !npz_file.empty(); }
};

/// Adds --csv, --npz, --wav, --events, --every and --mat to a verb.
/// @param rows  help of --every
void add_table_files(Verb& verb, TableOptions& options, const std::string& rows);

/// A file that a word of the command line names; empty where the word is not there.
struct NamedFile {
  std::string word;
  std::string path;
};

/// @throws UsageError when two words name one file, however they are written
void refuse_shared_files(const std::vector<NamedFile>& files);

/// Scenes, parts and devices may lie in any YAML file, and a take cannot be made again.
/// @param read  the files that the outputs are of, and what each is
/// @throws UsageError when a word names one of these files, an existing YAML file or a take
void refuse_overwriting(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& read);

/// @param read  the file that the table is of, and what it is: it is never written over
/// @param summary_file  of --summary, for a verb that has it; else empty
/// @param state_file  of --save-state, likewise
/// @throws UsageError when two words name one file, or one that has to be a file is stdout
void refuse_shared_files(const TableOptions& options, const NamedFile& read,
                         const std::string& summary_file = {}, const std::string& state_file = {});

/// What is wrong where --wav finds no sound.
inline constexpr const char* kNoSound =
    "--wav: the scene has no sound; add 'sound: true' to one of its signals";

/// Refuses a file that cannot be made before another one is replaced.
/// @param summary_file  of --summary, for a verb that has it; else empty
/// @throws UsageError
void refuse_impossible_files(const TableOptions& options, const std::string& summary_file = {});

/// Makes the files of the table.
/// @throws UsageError for a file that cannot be made
std::vector<std::unique_ptr<TableFile>> make_table_files(const TableOptions& options,
                                                         const std::vector<Column>& columns);

}  // namespace cordis::cli
