// node/log.cpp
#include "node/log.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <optional>
#include <semaphore>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/sink.h>
#include <unistd.h>

#include "node/config/nearest_word.h"
#include "node/config/problem.h"
#include "node/line_output.h"
#include "node/log_queue.h"
#include "node/terminal_text.h"

namespace cordis::node {
namespace {

constexpr std::size_t kMaxWaiting = 65536;  // [bytes]
constexpr std::size_t kLongestLine = 4096;  // [bytes]

/// stderr, coloured on a terminal. A thread of its own formats and writes: who logs takes no lock
/// and waits neither for who reads nor for another thread that logs.
class ErrorSink : public spdlog::sinks::sink {
 public:
  ErrorSink(std::string name, bool coloured)
      : name_(std::move(name)), output_(STDERR_FILENO, kMaxWaiting), coloured_(coloured) {
    thread_ = std::thread([this] { loop(); });
  }
  ~ErrorSink() override {
    ending_ = true;
    news_.release();
    thread_.join();
  }
  ErrorSink(const ErrorSink&) = delete;
  ErrorSink& operator=(const ErrorSink&) = delete;

  void log(const spdlog::details::log_msg& message) override {
    const std::string_view text(message.payload.data(), message.payload.size());
    if (!queue_.push(message.time, message.level, text)) lost_.fetch_add(1);
    news_.release();
  }

  /// Waits until all that was logged before has been given to the output.
  void flush() override {
    const std::uint32_t wanted = flush_wanted_.fetch_add(1) + 1;
    news_.release();
    for (std::uint32_t done = flushed_.load(); static_cast<std::int32_t>(wanted - done) > 0;
         done = flushed_.load()) {
      flushed_.wait(done);
    }
  }

  /// Before the first line.
  void set_pattern(const std::string& pattern) override {
    set_formatter(std::make_unique<spdlog::pattern_formatter>(pattern));
  }
  void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override {
    formatter_ = std::move(formatter);
  }

 private:
  void loop() {
    LogLine line;
    while (!ending_) {
      news_.acquire();
      const std::uint32_t wanted = flush_wanted_.load();
      while (queue_.pop(line)) write(line);
      output_.count_lost(lost_.exchange(0));
      if (flushed_.load() == wanted) continue;
      output_.flush();
      flushed_.store(wanted);
      flushed_.notify_all();
    }
    while (queue_.pop(line)) write(line);
  }

  void write(const LogLine& line) {
    const spdlog::details::log_msg message(line.time, {}, name_, line.level, line.text());
    spdlog::memory_buf_t formatted;
    formatter_->format(message, formatted);
    std::string_view text(formatted.data(), std::min(formatted.size(), kLongestLine));
    if (text.ends_with('\n')) text.remove_suffix(1);
    // Names of other processes may hold anything, and a line is a line.
    std::string shown;
    if (coloured_ && message.color_range_end > message.color_range_start) {
      const std::size_t start = message.color_range_start;
      const std::size_t end = message.color_range_end;
      shown = terminal_line(text.substr(0, start)) + colour_of(message.level) +
              terminal_line(text.substr(start, end - start)) + "\033[m";
      text.remove_prefix(end);
    }
    shown += terminal_line(text);
    if (formatted.size() > kLongestLine) shown += "...";
    output_.line(shown);
  }

  static const char* colour_of(spdlog::level::level_enum level) {
    // trace, debug, info, warning, error, critical: white, cyan, green, yellow, red, white on red
    constexpr std::array kColours{"\033[37m",        "\033[36m",        "\033[32m",
                                  "\033[33m\033[1m", "\033[31m\033[1m", "\033[1m\033[41m"};
    return kColours.at(static_cast<std::size_t>(level));
  }

  std::string name_;
  LineOutput output_;  // of the thread
  bool coloured_;
  std::unique_ptr<spdlog::formatter> formatter_;
  LogQueue queue_;
  std::atomic<std::uint64_t> lost_{0};  // lines that found no room
  std::counting_semaphore<> news_{0};
  std::atomic<std::uint32_t> flush_wanted_{0};
  std::atomic<std::uint32_t> flushed_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// The level that a person wants; nothing when no level has this name.
std::optional<spdlog::level::level_enum> level_named(const std::string& name) {
  const spdlog::level::level_enum level = spdlog::level::from_str(name);
  if (level == spdlog::level::off && name != "off") return std::nullopt;
  return level;
}

/// Sets the level that CORDIS_LOG_LEVEL names. A slip of the pen must not make a node silent.
void set_level(spdlog::logger& logger) {
  const char* wanted = std::getenv("CORDIS_LOG_LEVEL");
  if (wanted == nullptr || *wanted == '\0') return;
  if (const auto level = level_named(wanted)) {
    logger.set_level(*level);
    return;
  }
  const std::string near = config::did_you_mean(
      wanted, {"trace", "debug", "info", "warning", "error", "critical", "off"});
  logger.warn(
      "CORDIS_LOG_LEVEL={} is no level: trace, debug, info, warning, error, critical or off{}; it "
      "stays at info",
      wanted, near.empty() ? "" : " (" + near + ")");
}

}  // namespace

void install_log(const std::string& name) {
  const bool coloured = std::getenv("NO_COLOR") == nullptr && isatty(STDERR_FILENO) != 0;
  auto sink = std::make_shared<ErrorSink>(name, coloured);
  auto logger = std::make_shared<spdlog::logger>(name, sink);
  const bool launched = std::getenv("CORDIS_LAUNCHED") != nullptr;
  logger->set_pattern(launched ? "%^%l%$ %v" : "%H:%M:%S.%e %n %^%l%$ %v");
  set_level(*logger);
  spdlog::set_default_logger(std::move(logger));
}

void log_lines(spdlog::level::level_enum level, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::ranges::replace(line, '\t', ' ');  // a caret stays below its character
    spdlog::log(level, "{}", line);
  }
}

}  // namespace cordis::node
