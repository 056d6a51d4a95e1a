// node/log_queue.cpp
#include "node/log_queue.h"

#include <algorithm>
#include <utility>

namespace cordis::node {
namespace {

void put(std::string_view text, LogLine& line) noexcept {
  line.length = text.size();
  if (text.size() > LogLine::kShort) {
    try {
      line.long_text.assign(text);
      return;
    } catch (...) {  // without memory the beginning is better than nothing
      line.length = LogLine::kShort;
    }
  }
  std::copy_n(text.begin(), line.length, line.head.begin());
}

}  // namespace

LogQueue::LogQueue() noexcept {
  for (std::size_t i = 0; i < kRoom; ++i) cells_[i].turn.store(i, std::memory_order_relaxed);
}

bool LogQueue::push(spdlog::log_clock::time_point time, spdlog::level::level_enum level,
                    std::string_view text) noexcept {
  std::uint64_t number = pushed_.load(std::memory_order_relaxed);
  Cell* cell = nullptr;
  for (;;) {
    cell = &cells_[number % kRoom];
    const std::uint64_t turn = cell->turn.load(std::memory_order_acquire);
    if (turn < number) return false;  // still full from a round before
    if (turn > number) {              // another thread was faster
      number = pushed_.load(std::memory_order_relaxed);
    } else if (pushed_.compare_exchange_weak(number, number + 1, std::memory_order_relaxed)) {
      break;
    }
  }
  cell->line.time = time;
  cell->line.level = level;
  put(text, cell->line);
  cell->turn.store(number + 1, std::memory_order_release);
  return true;
}

bool LogQueue::pop(LogLine& line) noexcept {
  Cell& cell = cells_[popped_ % kRoom];
  if (cell.turn.load(std::memory_order_acquire) != popped_ + 1) return false;
  std::swap(line, cell.line);
  cell.turn.store(popped_ + kRoom, std::memory_order_release);
  ++popped_;
  return true;
}

}  // namespace cordis::node
