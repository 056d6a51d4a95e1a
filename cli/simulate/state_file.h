// cli/simulate/state_file.h -- the file of --save-state, which replaces an older state at the end.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/table/output_file.h"

namespace cordis::cli {

/// A file that keeps its old state until the new one is complete: it is written beside it. What is no
/// regular file, or `-`, is written where it is.
class StateFile {
 public:
  /// Makes the file beside it. @throws UsageError when that is not possible, or a file would be
  /// overwritten that holds no state.
  explicit StateFile(const std::string& path);
  /// Takes the file beside it away, unless finish() was called.
  ~StateFile();
  StateFile(const StateFile&) = delete;
  StateFile& operator=(const StateFile&) = delete;

  /// @throws std::runtime_error when the disk takes no more; the old state stays.
  void finish(const std::string& text);

 private:
  std::filesystem::path place_;   // links followed
  std::filesystem::path beside_;  // empty: written where it is
  std::optional<OutputFile> file_;
};

}  // namespace cordis::cli
