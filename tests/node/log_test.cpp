// tests/node/log_test.cpp
#include "node/log.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "node/log_queue.h"
#include "tests/support/eventually.h"

namespace cordis::node {
namespace {

/// A pipe in the place of stderr, and the logger of the other tests put aside.
class PipeAsError {
 public:
  /// @param level  CORDIS_LOG_LEVEL
  explicit PipeAsError(const char* level = "") {
    setenv("CORDIS_LOG_LEVEL", level, 1);
    EXPECT_EQ(pipe(ends_.data()), 0);
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    dup2(ends_[1], STDERR_FILENO);
    install_log("test");
  }
  ~PipeAsError() {
    unsetenv("CORDIS_LOG_LEVEL");
    spdlog::set_default_logger(former_);
    dup2(error_, STDERR_FILENO);
    for (const int file : {error_, ends_[0], ends_[1]}) close(file);
  }
  PipeAsError(const PipeAsError&) = delete;
  PipeAsError& operator=(const PipeAsError&) = delete;

  /// What the pipe holds.
  std::string look() const {
    std::array<char, 65536> block{};
    const ssize_t count = read(ends_[0], block.data(), block.size());
    return {block.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }

 private:
  std::array<int, 2> ends_{};
  int error_ = dup(STDERR_FILENO);
  std::shared_ptr<spdlog::logger> former_ = spdlog::default_logger();
};

TEST(Log, NeverWaitsForItsReaderAndSaysHowManyLinesAreMissing) {
  constexpr int kLines = 2000;  // of 100 bytes and more: three times what a pipe holds
  const PipeAsError error;
  auto logged = std::async(std::launch::async, [] {
    for (int i = 0; i < kLines; ++i) spdlog::info("{:0100}", i);
  });

  const auto is_done = [&](auto patience) {
    return logged.wait_for(patience) == std::future_status::ready;
  };
  EXPECT_TRUE(is_done(test::kPatience)) << "it waits for its reader";
  std::string seen;
  const auto read_all = [&] {
    spdlog::default_logger()->flush();
    for (std::string more = error.look(); !more.empty(); more = error.look()) {
      seen += more;
      spdlog::default_logger()->flush();
    }
  };
  read_all();
  spdlog::warn("end");
  read_all();
  EXPECT_NE(seen.find(" lines are missing here: they were not read in time\n"), std::string::npos);
  EXPECT_TRUE(seen.ends_with(" end\n"));
}

TEST(Log, HasALineForEachLineOfAText) {
  const PipeAsError error;
  log_lines(spdlog::level::warn, "refused\na.yaml:1:2: error: {} is wrong\n\tx\n\t^");
  spdlog::default_logger()->flush();

  const std::string seen = error.look();
  EXPECT_EQ(std::count(seen.begin(), seen.end(), '\n'), 4) << seen;
  EXPECT_NE(seen.find("warning a.yaml:1:2: error: {} is wrong\n"), std::string::npos) << seen;
  EXPECT_NE(seen.find("warning  ^\n"), std::string::npos) << seen;
  EXPECT_EQ(seen.find('?'), std::string::npos) << seen;
}

TEST(Log, SaysThatALevelIsUnknownAndStaysAtInfo) {
  const PipeAsError error("debgu");
  spdlog::debug("a detail");
  spdlog::info("a fact");
  spdlog::default_logger()->flush();

  const std::string seen = error.look();
  EXPECT_NE(seen.find("CORDIS_LOG_LEVEL=debgu is no level: trace, debug, info, warning, error, "
                      "critical or off (did you mean 'debug'?); it stays at info\n"),
            std::string::npos)
      << seen;
  EXPECT_NE(seen.find("a fact"), std::string::npos) << seen;
  EXPECT_EQ(seen.find("a detail"), std::string::npos) << seen;
}

TEST(Log, TakesEveryLevelThatHelpNames) {
  for (const char* level : {"trace", "debug", "info", "warning", "error", "critical", "off"}) {
    const PipeAsError error(level);
    spdlog::default_logger()->flush();
    EXPECT_EQ(error.look(), "") << level;
  }
  const PipeAsError error("debug");
  spdlog::debug("a detail");
  spdlog::default_logger()->flush();
  EXPECT_NE(error.look().find("a detail"), std::string::npos);
}

TEST(Log, KeepsALineALineWhateverNamesItHolds) {
  const PipeAsError error;
  spdlog::info("scene '{}'", "a\n12:00:00 sim error \033[2J");
  spdlog::info("device '{}'",
               "a\xc2\x9b"
               "2J\xe2\x80\xae"
               "b\xff\t");  // C1, direction, no UTF-8
  spdlog::info("{}", std::string(5000, 'x'));
  spdlog::default_logger()->flush();

  const std::string seen = error.look();
  EXPECT_NE(seen.find("scene 'a?12:00:00 sim error ?[2J'\n"), std::string::npos) << seen;
  EXPECT_NE(seen.find("device 'a?2J?b?\?'\n"), std::string::npos) << seen;
  EXPECT_NE(seen.find("xxx...\n"), std::string::npos);
}

TEST(LogQueue, KeepsTheOrderOfEveryThreadAndCountsWhatFindsNoRoom) {
  constexpr int kThreads = 4;
  constexpr int kEach = 20'000;
  const auto queue = std::make_unique<LogQueue>();
  std::atomic<int> lost{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < kEach; ++i) {
        const std::string text = std::to_string(t) + " " + std::to_string(i);
        const bool is_long = i % 7 == 0;
        if (!queue->push({}, spdlog::level::info, is_long ? text + std::string(300, ' ') : text))
          ++lost;
      }
    });
  }
  std::array<int, kThreads> last;
  last.fill(-1);
  int seen = 0;
  LogLine line;
  while (seen + lost < kThreads * kEach) {
    if (!queue->pop(line)) continue;
    int thread = 0;
    int number = 0;
    ASSERT_EQ(std::sscanf(std::string(line.text()).c_str(), "%d %d", &thread, &number), 2);
    ASSERT_GT(number, last.at(static_cast<std::size_t>(thread)));
    last.at(static_cast<std::size_t>(thread)) = number;
    ++seen;
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(seen, 0);
  EXPECT_FALSE(queue->pop(line));
}

TEST(LogQueue, RefusesWhatFindsNoRoom) {
  const auto queue = std::make_unique<LogQueue>();
  for (std::size_t i = 0; i < LogQueue::kRoom; ++i)
    ASSERT_TRUE(queue->push({}, spdlog::level::info, "in time"));
  EXPECT_FALSE(queue->push({}, spdlog::level::info, "too late"));
  LogLine line;
  ASSERT_TRUE(queue->pop(line));
  EXPECT_EQ(line.text(), "in time");
  EXPECT_TRUE(queue->push({}, spdlog::level::info, "there is room again"));
}

}  // namespace
}  // namespace cordis::node
