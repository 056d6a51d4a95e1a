// tests/node/new_file_test.cpp
#include "node/new_file.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

namespace cordis::node {
namespace {

namespace fs = std::filesystem;

std::string text_in(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class NewFile : public ::testing::Test {
 protected:
  NewFile() {
    char name[] = "/tmp/cordis-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~NewFile() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(NewFile, HasItsPermissionsWhateverTheUmask) {
  const mode_t before = umask(0);
  for (const mode_t mask : {0000, 0022, 0077, 0777}) {
    for (const mode_t mode : {0600, 0644, 0640}) {
      const fs::path file = folder_ / (std::to_string(mask) + "-" + std::to_string(mode));
      umask(mask);
      write_new_file(file, "text", mode);
      struct stat found {};
      ASSERT_EQ(stat(file.c_str(), &found), 0);
      EXPECT_EQ(found.st_mode & 07777, mode) << mask;
    }
  }
  umask(before);
}

TEST_F(NewFile, TakesThePlaceOfNothing) {
  write_new_file(folder_ / "file", "first", 0600);
  fs::create_symlink(folder_ / "elsewhere", folder_ / "link");

  EXPECT_THROW(write_new_file(folder_ / "file", "second", 0600), std::runtime_error);
  EXPECT_THROW(write_new_file(folder_ / "link", "second", 0600), std::runtime_error);
  EXPECT_EQ(text_in(folder_ / "file"), "first");
  EXPECT_FALSE(fs::exists(folder_ / "elsewhere"));
}

TEST_F(NewFile, IsWholeOrNotThere) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignored = signal(SIGXFSZ, SIG_IGN);
  rlimit few = before;
  few.rlim_cur = 4096;  // bytes: the disk is full behind them
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &few), 0);
  EXPECT_THROW(write_new_file(folder_ / "long", std::string(5000, 'a'), 0600), std::runtime_error);
  EXPECT_NO_THROW(write_new_file(folder_ / "short", std::string(4096, 'a'), 0600));
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, ignored);

  EXPECT_FALSE(fs::exists(folder_ / "long"));
  EXPECT_EQ(text_in(folder_ / "short").size(), 4096u);
}

}  // namespace
}  // namespace cordis::node
