// node/log.cpp
#include "node/log.h"

#include <cstdlib>

#include <spdlog/sinks/stdout_color_sinks.h>

namespace cordis::node {

void install_log(const std::string& name) {
  const auto colours = std::getenv("NO_COLOR") != nullptr ? spdlog::color_mode::never
                                                          : spdlog::color_mode::automatic;
  auto logger = std::make_shared<spdlog::logger>(
      name, std::make_shared<spdlog::sinks::stderr_color_sink_mt>(colours));
  const bool launched = std::getenv("CORDIS_LAUNCHED") != nullptr;
  logger->set_pattern(launched ? "%^%l%$ %v" : "%H:%M:%S.%e %n %^%l%$ %v");
  logger->flush_on(spdlog::level::info);
  if (const char* wanted = std::getenv("CORDIS_LOG_LEVEL")) {
    logger->set_level(spdlog::level::from_str(wanted));
  }
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace cordis::node
