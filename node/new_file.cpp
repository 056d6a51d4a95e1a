// node/new_file.cpp
#include "node/new_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "node/config/open_file.h"

namespace cordis::node {
namespace {

bool write_all(int file, std::string_view rest) noexcept {
  while (!rest.empty()) {
    const ssize_t count = write(file, rest.data(), rest.size());
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

void write_new_file(const std::filesystem::path& path, const std::string& text, mode_t mode) {
  const config::OpenFile file(
      open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode));
  const bool is_open = file.number() >= 0;
  if (is_open && fchmod(file.number(), mode) == 0 && write_all(file.number(), text)) return;
  const std::string why = std::strerror(errno);
  if (is_open) unlink(path.c_str());
  throw std::runtime_error(path.string() + " cannot be written: " + why);
}

}  // namespace cordis::node
