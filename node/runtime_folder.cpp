// node/runtime_folder.cpp
#include "node/runtime_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace cordis::node {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& folder, const std::string& why) {
  throw std::runtime_error("sessions cannot be recorded in " + folder.string() + ": " + why +
                           "; set CORDIS_RUNTIME_DIR to a folder of your own");
}

bool is_own_folder(const char* path) {
  struct stat found {};
  return path != nullptr && *path == '/' && stat(path, &found) == 0 && S_ISDIR(found.st_mode) &&
         found.st_uid == geteuid();
}

}  // namespace

std::filesystem::path runtime_folder() {
  const char* own = std::getenv("CORDIS_RUNTIME_DIR");
  const char* session = std::getenv("XDG_RUNTIME_DIR");
  std::filesystem::path folder = "/tmp/cordis-" + std::to_string(geteuid());
  if (own != nullptr && *own != '\0') {
    folder = std::filesystem::absolute(own);
  } else if (is_own_folder(session)) {
    folder = std::filesystem::path(session) / "cordis";
  }
  make_private_folder(folder);
  return folder;
}

void make_private_folder(const std::filesystem::path& folder) {
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) refuse(folder, std::strerror(errno));
  struct stat found {};
  if (lstat(folder.c_str(), &found) != 0) refuse(folder, std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) refuse(folder, "it is no folder");
  if (found.st_uid != geteuid()) refuse(folder, "it belongs to another user");
  if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0) refuse(folder, "other users may write there");
}

FolderLock::FolderLock(const std::filesystem::path& folder, std::chrono::milliseconds at_most) {
  const std::filesystem::path path = folder / "lock";
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (file_ < 0) refuse(folder, std::strerror(errno));
  const auto limit = std::chrono::steady_clock::now() + at_most;
  while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() >= limit) {
      close(file_);
      refuse(folder, "another process holds its lock and does not go on");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

FolderLock::~FolderLock() {
  close(file_);
}

}  // namespace cordis::node
