// node/config/regular_file.cpp
#include "node/config/regular_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/config/open_file.h"

namespace cordis::config {
namespace {

constexpr std::string_view kTakeMagic = "\x89MCAP0\r\n";  // as mcap::kMagic

/// What a file is that is no regular one.
std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "it is a directory";
  if (S_ISFIFO(mode)) return "it is a FIFO, and a regular file is wanted";
  if (S_ISSOCK(mode)) return "it is a socket, and a regular file is wanted";
  return "it is a device, and a regular file is wanted";
}

/// Appends what is left in a file; false when reading fails or more comes than is allowed.
bool append_rest(int file, std::size_t max_bytes, std::string& bytes) {
  constexpr std::size_t kBlock = 65536;
  for (;;) {
    const std::size_t before = bytes.size();
    if (before > max_bytes) return true;
    bytes.resize(before + kBlock);
    const ssize_t count = read(file, bytes.data() + before, kBlock);
    bytes.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count == 0) return true;
    if (count < 0 && errno != EINTR) return false;
  }
}

}  // namespace

FileBytes read_regular_file(const std::string& path, std::size_t max_bytes) {
  // Looked at before it is opened: the opening of a serial line resets a board.
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {{}, std::strerror(errno)};
  if (!S_ISREG(status.st_mode)) return {{}, kind_of(status.st_mode)};
  // Another file may have taken its name since: without O_NONBLOCK the opening of a FIFO waits.
  const OpenFile file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.number() < 0) return {{}, std::strerror(errno)};
  if (fstat(file.number(), &status) != 0) return {{}, std::strerror(errno)};
  if (!S_ISREG(status.st_mode)) return {{}, kind_of(status.st_mode)};
  FileBytes result;
  if (!append_rest(file.number(), max_bytes, result.bytes)) return {{}, "reading failed"};
  if (result.bytes.size() > max_bytes)
    return {{}, "it is larger than " + std::to_string(max_bytes >> 20) + " MiB"};
  return result;
}

std::filesystem::path path_below(const std::filesystem::path& folder,
                                 const std::filesystem::path& path) {
  std::error_code failure;
  const std::filesystem::path found = std::filesystem::weakly_canonical(path, failure);
  if (failure || folder.empty()) return {};
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), found.begin(), found.end());
  return end == folder.end() && rest != found.end() ? found : std::filesystem::path();
}

bool is_take_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  if (path.ends_with(".mcap") || path.ends_with(".mcap.part")) return true;
  std::string begin(kTakeMagic.size(), '\0');
  std::ifstream(path, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kTakeMagic;
}

std::string kept_kind_of(const std::string& path) {
  std::error_code ignored;
  const bool is_yaml = path.ends_with(".yaml") || path.ends_with(".yml");
  if (is_yaml && std::filesystem::is_regular_file(path, ignored)) return "YAML file";
  return is_take_file(path) ? "take" : "";
}

std::string reason_not_to_write(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  if (!S_ISREG(status.st_mode)) return kind_of(status.st_mode);
  const std::string kept = kept_kind_of(path);
  return kept.empty() ? "" : "it is a " + kept + ", and is never overwritten";
}

}  // namespace cordis::config
