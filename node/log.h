// node/log.h -- one line per message on stderr.
#pragma once

#include <string>

#include <spdlog/spdlog.h>

namespace cordis::node {

/// Sets up spdlog's default logger: stderr, `HH:MM:SS.mmm name level text`, colours on a terminal
/// unless NO_COLOR is set, level from CORDIS_LOG_LEVEL (trace, debug, info, warning, error) else
/// info. Who logs never waits for who reads: after 64 KiB lines are left out, which the next says.
/// Under the launcher (CORDIS_LAUNCHED set) time and name are left to the launcher. Then log with
/// spdlog::info(...) and the like.
void install_log(const std::string& name);

}  // namespace cordis::node
