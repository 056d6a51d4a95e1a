// tests/mcap/take_folder.h -- a folder for the files of one test.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace cordis::mcap {

/// Is there as long as the test, and empty at its start.
class TakeFolder {
 public:
  TakeFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("cordis_take_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TakeFolder() { std::filesystem::remove_all(path_); }
  TakeFolder(const TakeFolder&) = delete;
  TakeFolder& operator=(const TakeFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::vector<char> contents_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const std::filesystem::path& path, const std::vector<char>& contents) {
  std::ofstream(path, std::ios::binary).write(contents.data(), std::ssize(contents));
}

}  // namespace cordis::mcap
