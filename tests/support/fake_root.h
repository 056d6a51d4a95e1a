// tests/support/fake_root.h -- files of a machine that a test makes up.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "node/machine/system_files.h"

namespace cordis::machine {

/// A folder in the place of the root of the machine.
class FakeRoot {
 public:
  FakeRoot()
      : folder_(std::filesystem::path(testing::TempDir()) /
                ("cordis root " + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~FakeRoot() { std::filesystem::remove_all(folder_); }
  FakeRoot(const FakeRoot&) = delete;
  FakeRoot& operator=(const FakeRoot&) = delete;

  void put(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path) << text;
  }
  SystemFiles files() const { return SystemFiles(folder_); }

 private:
  std::filesystem::path folder_;
};

}  // namespace cordis::machine
