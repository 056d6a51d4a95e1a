// node/log.cpp
#include "node/log.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string_view>

#include <spdlog/sinks/base_sink.h>
#include <unistd.h>

#include "node/line_output.h"

namespace cordis::node {
namespace {

constexpr std::size_t kMostWaiting = 65536;  // [bytes]

/// stderr, coloured on a terminal. Who logs in a loop never waits for who reads.
class ErrorSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit ErrorSink(bool coloured) : output_(STDERR_FILENO, kMostWaiting), coloured_(coloured) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t formatted;
    formatter_->format(message, formatted);
    std::string line(formatted.data(), formatted.size());
    if (line.ends_with('\n')) line.pop_back();
    if (coloured_ && message.color_range_end > message.color_range_start) {
      line.insert(message.color_range_end, "\033[m");
      line.insert(message.color_range_start, colour_of(message.level));
    }
    output_.line(line);
  }
  void flush_() override { output_.flush(); }

  static const char* colour_of(spdlog::level::level_enum level) {
    // trace, debug, info, warning, error, critical: white, cyan, green, yellow, red, white on red
    constexpr std::array kColours{"\033[37m",        "\033[36m",        "\033[32m",
                                  "\033[33m\033[1m", "\033[31m\033[1m", "\033[1m\033[41m"};
    return kColours.at(static_cast<std::size_t>(level));
  }

  LineOutput output_;
  bool coloured_;
};

}  // namespace

void install_log(const std::string& name) {
  const bool coloured = std::getenv("NO_COLOR") == nullptr && isatty(STDERR_FILENO) != 0;
  auto logger = std::make_shared<spdlog::logger>(name, std::make_shared<ErrorSink>(coloured));
  const bool launched = std::getenv("CORDIS_LAUNCHED") != nullptr;
  logger->set_pattern(launched ? "%^%l%$ %v" : "%H:%M:%S.%e %n %^%l%$ %v");
  if (const char* wanted = std::getenv("CORDIS_LOG_LEVEL")) {
    logger->set_level(spdlog::level::from_str(wanted));
  }
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace cordis::node
