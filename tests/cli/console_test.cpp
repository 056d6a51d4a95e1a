// tests/cli/console_test.cpp
#include "cli/run/console.h"

#include <algorithm>
#include <csignal>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace cordis::cli {
namespace {

/// A pipe in the place of a terminal.
struct Screen {
  std::array<int, 2> ends{-1, -1};
  Screen() {
    std::signal(SIGPIPE, SIG_IGN);
    EXPECT_EQ(pipe(ends.data()), 0);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
  ~Screen() {
    hide();
    close(ends[1]);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  int file() const { return ends[1]; }
  /// What was written since, without waiting for more.
  std::string take_new_text() const {
    std::array<char, 65536> block{};
    const ssize_t count = read(ends[0], block.data(), block.size());
    return count > 0 ? std::string(block.data(), static_cast<std::size_t>(count)) : "";
  }
  void hide() {
    if (ends[0] >= 0) close(ends[0]);
    ends[0] = -1;
  }
};

TEST(Console, WritesWholeLinesToTheStreamTheyBelongTo) {
  Screen out;
  Screen error;
  Console console({out.file(), error.file()});
  console.line(Stream::kOut, "to out");
  console.line(Stream::kError, "to error");
  EXPECT_EQ(out.take_new_text(), "to out\n");
  EXPECT_EQ(error.take_new_text(), "to error\n");
}

TEST(Console, NeverWaitsForAReaderAndSaysHowManyLinesAreMissing) {
  Screen screen;
  Console console({screen.file(), screen.file()});
  const std::string text(1000, 'x');
  const std::size_t sent = 3 * Console::kMaxWaiting / text.size();

  for (std::size_t i = 0; i < sent; ++i)
    console.line(Stream::kOut, text);  // would hang here if it waited

  std::string seen;
  for (std::string block = screen.take_new_text(); !block.empty(); block = screen.take_new_text()) {
    seen += block;
    console.flush();
  }
  const auto shown = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), '\n'));
  EXPECT_EQ(seen.size(), shown * (text.size() + 1));  // whole lines alone
  EXPECT_LT(shown, sent);
  console.line(Stream::kOut, "end");
  EXPECT_EQ(screen.take_new_text(),
            "... " + std::to_string(sent - shown) +
                " lines are missing here: they were not read in time\nend\n");
}

TEST(Console, ForgetsAllWhenNobodyCanReadAnyMore) {
  Screen screen;
  Console console({screen.file(), screen.file()});
  screen.hide();
  console.line(Stream::kOut, "unread");
  console.flush();
  EXPECT_EQ(screen.take_new_text(), "");
}

}  // namespace
}  // namespace cordis::cli
