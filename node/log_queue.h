// node/log_queue.h -- lines on their way from the threads that log to the one that writes.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <spdlog/common.h>

namespace cordis::node {

/// One line of a log, not yet formatted.
struct LogLine {
  static constexpr std::size_t kShort = 192;  ///< [bytes] kept without allocating

  spdlog::log_clock::time_point time;
  spdlog::level::level_enum level = spdlog::level::info;
  std::size_t length = 0;
  std::array<char, kShort> head{};
  std::string long_text;  ///< instead of `head` when the line is longer

  std::string_view text() const noexcept {
    return length > kShort ? std::string_view(long_text) : std::string_view(head.data(), length);
  }
};

/// A queue with room for kRoom lines. Any thread pushes, one thread pops. A push takes no lock and
/// never waits, and a thread that is stopped in the middle of one holds up only the pop. It
/// allocates only for a line longer than LogLine::kShort.
class LogQueue {
 public:
  static constexpr std::size_t kRoom = 1024;

  LogQueue() noexcept;

  /// @return false when there is no room, and the line is lost
  [[nodiscard]] bool push(spdlog::log_clock::time_point time, spdlog::level::level_enum level,
                          std::string_view text) noexcept;

  /// Swaps the oldest line with `line`; false when there is none.
  [[nodiscard]] bool pop(LogLine& line) noexcept;

 private:
  struct Cell {
    /// The number of the push that may fill the cell, and one more once it is filled.
    std::atomic<std::uint64_t> turn{0};
    LogLine line;
  };
  std::array<Cell, kRoom> cells_;
  std::atomic<std::uint64_t> pushed_{0};
  std::uint64_t popped_ = 0;
};

}  // namespace cordis::node
