// tests/mcap/output_file_test.cpp -- a new take beside programs that look for unfinished ones.
#include "record_node/mcap/output_file.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include "record_node/mcap/file_error.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

using Clock = std::chrono::steady_clock;

/// Locks a file as soon as it exists, as `unfinished_takes` does, and holds the lock for a while.
class Looker {
 public:
  Looker(const std::filesystem::path& path, std::chrono::milliseconds hold)
      : thread_([this, path, hold] { look(path, hold); }) {}
  ~Looker() {
    ends_ = true;
    thread_.join();
  }
  bool held() const { return held_; }  ///< it had the lock before the file was locked by its maker

 private:
  void look(const std::filesystem::path& path, std::chrono::milliseconds hold) {
    int file = -1;
    while (file < 0 && !ends_) file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    held_ = ::flock(file, LOCK_SH | LOCK_NB) == 0;
    const auto end = Clock::now() + hold;
    while (held_ && !ends_ && Clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::close(file);
  }
  std::atomic<bool> ends_{false};
  std::atomic<bool> held_{false};
  std::thread thread_;
};

/// Makes files until a looker was faster once. @return whether that file was made
enum class Outcome { kMade, kRefused, kNeverMet };
Outcome meet(std::chrono::milliseconds hold) {
  const TakeFolder folder;
  const auto end = Clock::now() + std::chrono::seconds(60);
  for (int i = 0; Clock::now() < end; ++i) {
    const std::filesystem::path path = folder / ("take" + std::to_string(i));
    Outcome outcome = Outcome::kMade;
    bool met = false;
    {
      Looker looker(path, hold);
      OutputFile file;
      try {
        file.create(path);
      } catch (const FileError&) {
        outcome = Outcome::kRefused;
      }
      met = looker.held();
    }
    std::filesystem::remove(path);
    if (met) return outcome;
    EXPECT_EQ(outcome, Outcome::kMade) << "no lock was held";
  }
  return Outcome::kNeverMet;
}

TEST(OutputFile, WaitsForWhoLooksAtAllTakes) {
  const Outcome outcome = meet(std::chrono::milliseconds(50));
  if (outcome == Outcome::kNeverMet) GTEST_SKIP() << "the two threads never met in 60 s";
  EXPECT_EQ(outcome, Outcome::kMade);
}

TEST(OutputFile, IsRefusedWhereAnotherProgramKeepsTheLock) {
  const Outcome outcome = meet(std::chrono::seconds(60));
  if (outcome == Outcome::kNeverMet) GTEST_SKIP() << "the two threads never met in 60 s";
  EXPECT_EQ(outcome, Outcome::kRefused);
}

}  // namespace
}  // namespace cordis::mcap
