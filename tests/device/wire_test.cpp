// tests/device/wire_test.cpp -- a line that takes no more, and one that no epoll watches.
#include "device_node/drivers/wire.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <unistd.h>

#include "node/config/yaml_reader.h"
#include "tests/support/captured_log.h"
#include "tests/support/eventually.h"
#include "tests/support/pseudo_terminal.h"

namespace {

std::atomic<int> error_of_create = 0;  // 0: the system decides
std::atomic<int> error_of_wait = 0;

/// The function of the C library that this program has under the same name.
template <class Function>
Function* of_library(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// Two functions of the C library, as the lines of this program call them.
extern "C" int epoll_create1(int flags) noexcept {
  if (error_of_create == 0) return of_library<decltype(epoll_create1)>("epoll_create1")(flags);
  errno = error_of_create;
  return -1;
}

extern "C" int epoll_pwait2(int file, epoll_event* events, int count, const timespec* limit,
                            const sigset_t* signals) {
  if (error_of_wait == 0)
    return of_library<decltype(epoll_pwait2)>("epoll_pwait2")(file, events, count, limit, signals);
  errno = error_of_wait;
  return -1;
}

namespace cordis::device {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A serial line whose board reads only when the test does.
class BlockedLine : public ::testing::Test {
 protected:
  BlockedLine() {
    master_ = test::open_board_end();
    config::Problems problems;
    const config::Value section =
        config::load_text("{port: " + std::string(ptsname(master_)) + "}", "line", problems);
    config::MappingReader reader(section, "line", problems);
    wire_ = read_wire(reader, 115200);
  }
  ~BlockedLine() override { close(master_); }

  static Bytes message_of(std::uint8_t number) { return Bytes(10, number); }

  /// Sends until the line takes no more. @return the number of the message that did not go whole
  std::uint8_t fill() {
    for (int n = 1; n < 1'000'000; ++n) {
      const auto number = static_cast<std::uint8_t>(1 + n % 200);
      if (!wire_->send(message_of(number))) return number;
    }
    return 0;
  }

  /// All that is on its way to the board.
  Bytes read_all() const {
    Bytes all;
    std::array<std::uint8_t, 4096> block{};
    for (;;) {
      const ssize_t count = ::read(master_, block.data(), block.size());
      if (count <= 0) return all;
      all.insert(all.end(), block.begin(), block.begin() + count);
    }
  }

  /// Reads until so many bytes have come.
  Bytes read_until(std::size_t count) const {
    Bytes all;
    for (int n = 0; n < 30'000 && all.size() < count; ++n) {
      const Bytes more = read_all();
      all.insert(all.end(), more.begin(), more.end());
      usleep(1000);
    }
    return all;
  }

  static constexpr std::array<std::uint8_t, 3> kRelease{0xa5, 0x5a, 0xff};

  /// Opens the line, fills it, and takes the force from the motors.
  void release_while_full() {
    ReleaseFrame release;
    std::copy(kRelease.begin(), kRelease.end(), release.bytes.begin());
    release.length = kRelease.size();
    wire_->set_release(release);
    ASSERT_TRUE(wire_->open());
    ASSERT_NE(fill(), 0);
    wire_->release();
  }

  static bool ends_with_release(const Bytes& all) {
    return all.size() >= kRelease.size() &&
           std::equal(kRelease.begin(), kRelease.end(), all.end() - kRelease.size());
  }

  int master_ = -1;
  std::unique_ptr<Wire> wire_;
};

TEST_F(BlockedLine, NoMessageBeginsInTheMiddleOfAnother) {
  ASSERT_TRUE(wire_->open());
  ASSERT_NE(fill(), 0);
  EXPECT_TRUE(wire_->is_open());
  Bytes all = read_until(1);
  const std::size_t before = all.size();

  ASSERT_TRUE(wire_->send(message_of(250)));
  const Bytes more = read_until(10);
  all.insert(all.end(), more.begin(), more.end());

  EXPECT_GE(all.size(), before + 10);
  ASSERT_EQ(all.size() % 10, 0u) << "whole messages alone";
  for (std::size_t begin = 0; begin < all.size(); begin += 10) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
    EXPECT_TRUE(std::all_of(first, first + 10, [&](auto byte) { return byte == *first; })) << begin;
  }
  EXPECT_EQ(all.back(), 250);
}

TEST_F(BlockedLine, TheReleaseFrameGoesBeforeAllThatWaits) {
  ASSERT_NO_FATAL_FAILURE(release_while_full());

  const Bytes all = read_until(kRelease.size());
  ASSERT_GE(all.size(), kRelease.size());
  EXPECT_TRUE(ends_with_release(all));
}

/// A board that reads late gets the release frame of a line that was closed and opened again since.
TEST_F(BlockedLine, TheReleaseFrameOutlivesTheNextOpening) {
  ASSERT_NO_FATAL_FAILURE(release_while_full());

  wire_->close();
  ASSERT_TRUE(wire_->open());

  Bytes all;
  EXPECT_TRUE(test::eventually([&] {
    const Bytes more = read_all();
    all.insert(all.end(), more.begin(), more.end());
    return ends_with_release(all);
  }));
}

/// A system that refuses an epoll, which a line does without.
class LineWithoutEdges : public BlockedLine {
 protected:
  ~LineWithoutEdges() override { error_of_create = error_of_wait = 0; }

  /// Opens the line twice. What a board sends arrives, and one line of the log says how it is read.
  void expect_bytes_and_one_warning(const std::string& reason) {
    const test::CapturedLog log;
    for (const char sent : {'a', 'b'}) {
      ASSERT_TRUE(wire_->open());
      ASSERT_EQ(::write(master_, &sent, 1), 1);
      std::array<std::uint8_t, 8> bytes{};
      ASSERT_TRUE(test::eventually(
          [&] { return wire_->receive(bytes, std::chrono::milliseconds(5)) == 1; }));
      EXPECT_EQ(bytes[0], sent);
      EXPECT_EQ(wire_->receive(bytes, std::chrono::nanoseconds(0)), 0u);
    }
    EXPECT_EQ(log.lines(""), wire_->address() +
                                 " is read by poll(), which may hold up the force loop of a busy "
                                 "machine: " +
                                 reason + "\n");
  }
};

TEST_F(LineWithoutEdges, IsReadByPollWhereTheSystemLacksTheWait) {
  error_of_wait = ENOSYS;
  expect_bytes_and_one_warning("Function not implemented");
}

TEST_F(LineWithoutEdges, IsReadByPollWhereTheWaitIsForbidden) {
  error_of_wait = EPERM;
  expect_bytes_and_one_warning("Operation not permitted");
}

TEST_F(LineWithoutEdges, IsReadByPollWhereTheProcessHasNoFileLeftToWatchIt) {
  error_of_create = EMFILE;
  expect_bytes_and_one_warning("Too many open files");
}

}  // namespace
}  // namespace cordis::device
