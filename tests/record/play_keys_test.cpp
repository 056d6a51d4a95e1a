// tests/record/play_keys_test.cpp -- `cordis play` on a terminal, and the keys that a user presses.
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include "tests/record/count_take.h"

namespace cordis {
namespace {

/// A program on a terminal of its own, as a user has it in front of them.
class ProgramOnATerminal {
 public:
  explicit ProgramOnATerminal(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    EXPECT_EQ(openpty(&terminal_, &line_, nullptr, nullptr, nullptr), 0);
    id_ = fork();
    if (id_ == 0) {
      std::signal(SIGINT, SIG_DFL);
      login_tty(line_);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
  }
  ~ProgramOnATerminal() {
    if (id_ > 0) {
      kill(id_, SIGKILL);
      waitpid(id_, nullptr, 0);
    }
    const std::string begin = seen_.substr(0, 2000);
    if (::testing::Test::HasFailure()) std::fprintf(stderr, "---- terminal\n%s\n", begin.c_str());
    close(line_);
    close(terminal_);
  }
  ProgramOnATerminal(const ProgramOnATerminal&) = delete;
  ProgramOnATerminal& operator=(const ProgramOnATerminal&) = delete;

  void press(const std::string& keys) {
    EXPECT_EQ(write(terminal_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }

  /// Waits until the terminal shows a text that was not there at the last call.
  bool shows(const std::string& text) {
    return test::eventually([&] {
      look();
      const std::size_t found = seen_.find(text, from_);
      if (found == std::string::npos) return false;
      from_ = found + text.size();
      return true;
    });
  }

  /// The exit code, once it has ended.
  int wait() {
    int status = 0;
    const bool ended = test::eventually([&] {
      look();
      return waitpid(id_, &status, WNOHANG) == id_;
    });
    if (!ended) return -1;
    id_ = -1;
    look();
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// True if the terminal echoes what is typed and waits for Enter.
  bool takes_lines() const {
    termios now{};
    EXPECT_EQ(tcgetattr(line_, &now), 0);
    return (now.c_lflag & ICANON) != 0 && (now.c_lflag & ECHO) != 0;
  }

 private:
  void look() {
    pollfd output{terminal_, POLLIN, 0};
    char text[4096];
    while (poll(&output, 1, 0) > 0 && (output.revents & POLLIN) != 0) {
      const ssize_t count = read(terminal_, text, sizeof text);
      if (count <= 0) return;
      seen_.append(text, static_cast<std::size_t>(count));
    }
  }

  pid_t id_ = -1;
  int terminal_ = -1;  // where the user sits
  int line_ = -1;  // what the program has; kept open, for its settings are read when it has ended
  std::string seen_;
  std::size_t from_ = 0;
};

class PlayKeysOnATerminal : public ::testing::Test {
 protected:
  PlayKeysOnATerminal() { test::write_count_take(take_); }

  std::vector<std::string> words(const std::string& session) const {
    return {CORDIS_PROGRAM_DIR "/cordis",       "play",      take_,  "--start-paused", "--domain",
            std::to_string(test::own_domain()), "--session", session};
  }

  mcap::TakeFolder folder_;
  const std::string take_ = folder_ / "take.mcap";
};

const std::string kUp = "\033[A";
const std::string kDown = "\033[B";
const std::string kRight = "\033[C";

TEST_F(PlayKeysOnATerminal, StepChangeTheRateAndGoOn) {
  ProgramOnATerminal player(words("keys"));
  ASSERT_TRUE(player.shows("rate 1  0 messages  paused"));
  EXPECT_FALSE(player.takes_lines());
  player.press(kRight);
  EXPECT_TRUE(player.shows("1 messages  paused"));
  player.press(kUp);
  EXPECT_TRUE(player.shows("rate 1.1  1 messages  paused"));
  player.press(kDown);
  EXPECT_TRUE(player.shows("rate 1  1 messages  paused"));
  player.press(" ");
  EXPECT_EQ(player.wait(), 0);
  EXPECT_TRUE(player.shows("40 messages played"));
  EXPECT_TRUE(player.takes_lines());
}

/// As a key that repeats gives them.
TEST_F(PlayKeysOnATerminal, CountEachWhenTheyComeTogether) {
  ProgramOnATerminal player(words("many_keys"));
  ASSERT_TRUE(player.shows("0 messages  paused"));
  player.press(kRight + kRight + kRight);
  EXPECT_TRUE(player.shows("3 messages  paused"));
  player.press(kUp + "x" + kUp + "\033[D" + kRight);  // two that mean nothing between them
  EXPECT_TRUE(player.shows("rate 1.21  4 messages  paused"));
  player.press("\033");
  player.press("[C");  // in two pieces
  EXPECT_TRUE(player.shows("5 messages  paused"));
  player.press("  ");  // it goes on, and stops again
  player.press(kRight);
  EXPECT_TRUE(player.shows("messages  paused"));
  player.press("\003");  // Ctrl-C
  EXPECT_EQ(player.wait(), 0);
  EXPECT_TRUE(player.takes_lines());
}

}  // namespace
}  // namespace cordis
