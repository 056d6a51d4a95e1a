// tests/node/log_test.cpp
#include "node/log.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace cordis::node {
namespace {

/// A pipe in the place of stderr, and the logger of the other tests put aside.
class PipeAsError {
 public:
  PipeAsError() {
    EXPECT_EQ(pipe(ends_.data()), 0);
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    dup2(ends_[1], STDERR_FILENO);
    install_log("test");
  }
  ~PipeAsError() {
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
  EXPECT_TRUE(is_done(std::chrono::seconds(10))) << "it waits for its reader";
  std::string seen;
  while (!is_done(std::chrono::seconds(0))) seen += error.look();
  seen += error.look();
  spdlog::warn("end");
  for (std::string more = error.look(); !more.empty(); more = error.look()) {
    seen += more;
    spdlog::default_logger()->flush();
  }
  EXPECT_NE(seen.find(" lines are missing here: nobody read them in time\n"), std::string::npos);
  EXPECT_TRUE(seen.ends_with(" end\n"));
}

}  // namespace
}  // namespace cordis::node
