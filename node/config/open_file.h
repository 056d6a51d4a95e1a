// node/config/open_file.h -- a file descriptor that is closed at the end of a scope.
#pragma once

#include <unistd.h>

namespace cordis::config {

class OpenFile {
 public:
  /// @param file  what open() gave; < 0: none
  explicit OpenFile(int file) noexcept : file_(file) {}
  ~OpenFile() {
    if (file_ >= 0) close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int number() const noexcept { return file_; }

 private:
  int file_;
};

}  // namespace cordis::config
