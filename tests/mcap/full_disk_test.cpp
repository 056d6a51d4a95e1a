// tests/mcap/full_disk_test.cpp -- a recorder that finds no more room closes a whole take.
#include <csignal>
#include <functional>
#include <random>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "record_node/mcap/file_error.h"
#include "record_node/mcap/take_check.h"
#include "tests/mcap/random_take.h"
#include "tests/mcap/take_folder.h"

namespace cordis::mcap {
namespace {

/// Writes until there is no more room, says so in the take, and closes it.
/// @return what is not as it has to be; empty: all is
std::string write_until_full(const std::filesystem::path& path, std::uint64_t limit) {
  constexpr std::size_t kMaxCount = 1'000'000;
  constexpr std::uint64_t kChunk = 600'000;  // of 250 ms, and the reserve [bytes]
  std::mt19937 random(3);
  Writer writer(path);
  const std::uint16_t channel = writer.add_channel({0, 0, "scene/frame", "cdr", {}});
  std::uint64_t taken = 0;
  std::uint64_t now = 1;
  WriteStatus status = WriteStatus::kOk;
  for (std::size_t i = 0; i < kMaxCount && status == WriteStatus::kOk; ++i, now += 10'000'000) {
    std::vector<std::byte> data(20'000);
    for (std::byte& byte : data) byte = static_cast<std::byte>(random());
    status = writer.write({channel, static_cast<std::uint32_t>(i), now, now, data});
    if (status == WriteStatus::kOk) status = writer.close_chunk_if_older(now);
    ++taken;
  }
  if (status != WriteStatus::kFull) return "it was never full";
  const std::uint64_t used = writer.size();
  if (used > limit || used + kChunk < limit) return "full with " + std::to_string(used) + " bytes";
  if (writer.problem().find("no room") == std::string::npos) return writer.problem();
  if (writer.write({channel, 0, now, now, {}}) != WriteStatus::kFull) return "it goes on";
  // As many words as the counts of many topics.
  const std::string words(60'000, 'x');
  if (writer.add_metadata({"cordis.recorder", {{"stopped", words}}}) != WriteStatus::kOk)
    return "no room for the last words";
  if (writer.close() != WriteStatus::kFull) return "it does not say that it was full";
  if (writer.lost_count() == 0) return "it does not say what was lost";
  const TakeCheck check = check_take(path);
  if (!check.faults.empty()) return check.faults.front().text;
  const Reader reader(path);
  if (!reader.is_whole()) return reader.damage();
  if (reader.metadata().size() != 1) return "the last words are missing";
  if (messages_of(reader).size() + writer.lost_count() != taken)
    return "messages that are neither kept nor counted as lost";
  return {};
}

/// What a function said in a process of its own, which may lose rights and folders.
std::string in_another_process(const std::function<std::string()>& say) {
  int pipe[2] = {-1, -1};
  EXPECT_EQ(::pipe(pipe), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    std::string words;
    try {
      words = say();
    } catch (const std::exception& error) {
      words = error.what();
    }
    const bool is_said = ::write(pipe[1], words.data(), words.size()) >= 0;
    ::_exit(is_said ? 0 : 1);
  }
  ::close(pipe[1]);
  std::string words;
  char letters[512];
  for (ssize_t count = 0; (count = ::read(pipe[0], letters, sizeof letters)) > 0;)
    words.append(letters, static_cast<std::size_t>(count));
  ::close(pipe[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFEXITED(status)) words += " (killed by signal " + std::to_string(WTERMSIG(status)) + ")";
  return words;
}

TEST(FullDisk, ALimitOfTheProcessLeavesAWholeTake) {
  const TakeFolder folder;
  for (const std::uint64_t limit : {400'000u, 1'500'001u, 5'000'000u}) {
    EXPECT_EQ(in_another_process([&folder, limit] {
                const rlimit most{limit, limit};
                if (::setrlimit(RLIMIT_FSIZE, &most) != 0)
                  return std::string("no limit can be set");
                return write_until_full(folder / (std::to_string(limit) + ".mcap"), limit);
              }),
              "");
  }
}

constexpr const char* kNoMount = "no tmpfs can be mounted here";

TEST(FullDisk, AFullTmpfsLeavesAWholeTake) {
  const TakeFolder folder;
  for (const unsigned pages : {100u, 513u, 2000u}) {
    const auto disk = folder / std::to_string(pages);
    std::filesystem::create_directory(disk);
    const std::string words = in_another_process([&disk, pages] {
      if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
        return std::string(kNoMount);
      const std::string size = "size=" + std::to_string(pages * 4096);
      ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
      if (::mount("none", disk.c_str(), "tmpfs", 0, size.c_str()) != 0)
        return std::string(kNoMount);
      return write_until_full(disk / "take.mcap", std::uint64_t{pages} * 4096);
    });
    if (words == kNoMount) GTEST_SKIP() << kNoMount << "; the limit of a process is tested";
    EXPECT_EQ(words, "") << pages << " pages";
  }
}

TEST(FullDisk, ATakeThatHasNoRoomAtAllIsRefused) {
  const TakeFolder folder;
  const std::string words = in_another_process([&folder]() -> std::string {
    const rlimit most{100, 100};
    ::setrlimit(RLIMIT_FSIZE, &most);
    const Writer writer(folder / "take.mcap");
    return "it was made";
  });
  EXPECT_NE(words.find("cannot be written"), std::string::npos) << words;
  EXPECT_FALSE(std::filesystem::exists(folder / "take.mcap.part"));
}

TEST(Killed, ARecorderLosesAtMostItsOpenChunk) {
  const TakeFolder folder;
  for (int round = 0; round < 5; ++round) {
    const auto path = folder / ("killed" + std::to_string(round) + ".mcap");
    int pipe[2] = {-1, -1};
    ASSERT_EQ(::pipe(pipe), 0);
    const pid_t child = ::fork();
    if (child == 0) {  // one byte for each message that is in a chunk that is closed
      Writer writer(path);
      const std::uint16_t channel = writer.add_channel({0, 0, "gesture/forces", "cdr", {}});
      const std::vector<std::byte> data(100);
      std::uint64_t said = 0;
      for (std::uint64_t now = 1;; now += 1'000'000) {
        static_cast<void>(writer.write({channel, 0, now, now, data}));
        static_cast<void>(writer.close_chunk_if_older(now));
        for (; said < writer.statistics().message_count; ++said) {
          if (::write(pipe[1], "x", 1) != 1) ::_exit(1);
        }
      }
    }
    ::close(pipe[1]);
    std::size_t promised = 0;
    char letters[64];
    const std::size_t enough = 3000 + 777 * static_cast<std::size_t>(round);
    while (promised < enough) {
      const ssize_t count = ::read(pipe[0], letters, sizeof letters);
      ASSERT_GT(count, 0);
      promised += static_cast<std::size_t>(count);
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    for (ssize_t count = 0; (count = ::read(pipe[0], letters, sizeof letters)) > 0;)
      promised += static_cast<std::size_t>(count);
    ::close(pipe[0]);

    const Reader reader(part_of(path));
    EXPECT_FALSE(reader.is_whole());
    EXPECT_GE(messages_of(reader).size(), promised);
    EXPECT_THROW(Writer{path}, FileError);  // an unfinished take is not overwritten
  }
}

}  // namespace
}  // namespace cordis::mcap
