// node/runtime_folder.h -- where the sessions of a user on this host are recorded.
#pragma once

#include <chrono>
#include <filesystem>

namespace cordis::node {

/// The folder for files that live as long as sessions: $CORDIS_RUNTIME_DIR when it is set, else
/// $XDG_RUNTIME_DIR/cordis where that is a folder of this user, else /tmp/cordis-UID. Makes it if
/// need be.
/// @throws std::runtime_error when it cannot be made, is no folder, or others may write there.
std::filesystem::path runtime_folder();

/// Makes a folder that only this user may enter, or checks the one that is there.
/// @throws std::runtime_error as runtime_folder()
void make_private_folder(const std::filesystem::path& folder);

/// Holds the lock of a folder: one process at a time has it, whichever way the last one ended.
class FolderLock {
 public:
  /// Waits for it, at most so long: a process that is stopped while it has the lock may go on later.
  /// @throws std::runtime_error when it is not to be had.
  explicit FolderLock(const std::filesystem::path& folder,
                      std::chrono::milliseconds at_most = std::chrono::seconds(20));
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace cordis::node
