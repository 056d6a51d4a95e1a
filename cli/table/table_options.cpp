// cli/table/table_options.cpp
#include "cli/table/table_options.h"

#include <cstddef>
#include <filesystem>
#include <system_error>

#include "cli/table/csv_file.h"
#include "cli/table/npz_file.h"
#include "cli/table/output_file.h"
#include "node/config/regular_file.h"

namespace cordis::cli {

void add_table_files(Verb& verb, TableOptions& options, const std::string& rows) {
  verb.option("--csv", "FILE", options.csv_file, "Write a table; - for stdout");
  verb.option("--npz", "FILE", options.npz_file, "Write the table for NumPy");
  verb.option("--wav", "FILE", options.wav_file,
              "Write the signals with `sound: true`, as WAV of 32-bit floating point");
  verb.option("--events", "FILE", options.events_file,
              "Write the changes of state, comma-separated; - for stdout");
  verb.option("--every", "ROWS", options.every, rows);
  verb.list("--mat", "NAME,...", options.mats,
            "Also the positions of these MATs: string, string[3], string[2..5]");
}

namespace {

/// True if two words name one file, however they are written.
bool are_one_file(const std::string& one, const std::string& other) {
  std::error_code failure;
  if (one == other || std::filesystem::equivalent(one, other, failure)) return true;
  const std::filesystem::path place = std::filesystem::weakly_canonical(one, failure);
  return !failure && place == std::filesystem::weakly_canonical(other, failure) && !failure;
}

}  // namespace

void refuse_shared_files(const std::vector<NamedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].path.empty() || files[j].path.empty()) continue;
      if (are_one_file(files[i].path, files[j].path))
        throw UsageError(files[j].word + " and " + files[i].word + " name the same file");
    }
  }
}

void refuse_overwriting(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& read) {
  for (const NamedFile& file : outputs) {
    if (file.path.empty() || file.path == "-") continue;
    for (const NamedFile& source : read) {
      if (are_one_file(file.path, source.path))
        throw UsageError(file.word + " would overwrite " + source.word + " " + source.path);
    }
    const std::string kept = config::kept_kind_of(file.path);
    if (!kept.empty())
      throw UsageError(file.word + " would overwrite the " + kept + " " + file.path);
  }
}

void refuse_shared_files(const TableOptions& options, const NamedFile& read,
                         const std::string& summary_file, const std::string& state_file) {
  const std::vector<NamedFile> files{
      {"--csv", options.csv_file},       {"--npz", options.npz_file}, {"--wav", options.wav_file},
      {"--events", options.events_file}, {"--summary", summary_file}, {"--save-state", state_file},
  };
  refuse_shared_files(files);
  refuse_overwriting({files.begin(), files.end() - 1}, {read});  // StateFile guards a state
  for (const NamedFile& file : {files[1], files[2]}) {
    if (file.path == "-") throw UsageError(file.word + " wants a file, not stdout");
  }
}

void refuse_impossible_files(const TableOptions& options, const std::string& summary_file) {
  for (const std::string& path :
       {options.csv_file, options.npz_file, options.wav_file, options.events_file, summary_file}) {
    std::error_code unknown;
    // A pipe would end for its reader, when this end is closed.
    const bool is_pipe = std::filesystem::is_fifo(path, unknown);
    if (path.empty() || path == "-" || is_pipe) continue;
    const OutputFile is_possible(path);
  }
}

std::vector<std::unique_ptr<TableFile>> make_table_files(const TableOptions& options,
                                                         const std::vector<Column>& columns) {
  std::vector<std::unique_ptr<TableFile>> files;
  if (!options.csv_file.empty())
    files.push_back(std::make_unique<CsvFile>(options.csv_file, columns));
  if (!options.npz_file.empty())
    files.push_back(std::make_unique<NpzFile>(options.npz_file, columns));
  return files;
}

}  // namespace cordis::cli
