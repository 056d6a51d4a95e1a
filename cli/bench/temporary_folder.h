// cli/bench/temporary_folder.h -- a folder for the files of a measurement.
#pragma once

#include <filesystem>

namespace cordis::cli {

/// A new folder among the temporary files; it is removed with all it holds when this is destroyed.
class TemporaryFolder {
 public:
  /// @throws std::runtime_error when there can be none
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace cordis::cli
