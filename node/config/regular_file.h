// node/config/regular_file.h -- files that a person named, opened without ever waiting for one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace cordis::config {

/// The bytes of a file, or why there are none.
struct FileBytes {
  std::string bytes;
  std::string reason;  ///< empty when the file was read
};

/// Reads a regular file. A FIFO, a socket or a device is refused without waiting for its other end.
/// @param max_bytes  a larger file is refused
[[nodiscard]] FileBytes read_regular_file(const std::string& path, std::size_t max_bytes);

/// The path below `folder`, which has no links, with links and `..` resolved; empty when it is not below it.
std::filesystem::path path_below(const std::filesystem::path& folder,
                                 const std::filesystem::path& path);

/// True if it is a regular file that is a take: by its first bytes, or by its name alone when those
/// are damaged.
bool is_take_file(const std::string& path);

/// What is never replaced by an output: "YAML file" or "take"; empty for any other path.
std::string kept_kind_of(const std::string& path);

/// Why a file cannot be written: the path exists and is no regular file, or kept_kind_of() names it.
/// Empty when it can be. Does not create it.
std::string reason_not_to_write(const std::string& path);

}  // namespace cordis::config
