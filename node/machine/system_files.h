// node/machine/system_files.h -- the files in which the kernel describes the machine.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cordis::machine {

/// Reads files below a root folder. A file that is missing or not readable is no error: machines
/// differ, and containers hide much.
class SystemFiles {
 public:
  explicit SystemFiles(std::filesystem::path root = "/") : root_(std::move(root)) {}

  /// @param path  from the root, without a leading slash: "proc/stat"
  std::filesystem::path full_path(const std::string& path) const { return root_ / path; }

  /// The whole text without white space at its end; nothing when it cannot be read.
  std::optional<std::string> text(const std::string& path) const;

  /// Whole text of a file compressed by gzip; nothing when it cannot be read.
  std::optional<std::string> gzip_text(const std::string& path) const;

  /// Names in `folder` that begin with `beginning`, in order; none when there is no such folder.
  std::vector<std::string> names(const std::string& folder, const std::string& beginning) const;

 private:
  std::filesystem::path root_;
};

}  // namespace cordis::machine
