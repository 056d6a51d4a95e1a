// node/log.h -- one line per message on stderr.
#pragma once

#include <string>

#include <spdlog/spdlog.h>

namespace cordis::node {

/// Sets up spdlog's default logger: stderr, `HH:MM:SS.mmm name level text`, colours on a terminal
/// unless NO_COLOR is set, level from CORDIS_LOG_LEVEL (trace, debug, info, warning, error,
/// critical, off) else info; a word that names none is reported. A thread of its own writes: who logs
/// takes no lock and never waits, so that a loop may log. After 64 KiB that are not read lines
/// are left out, which the next says. spdlog::default_logger()->flush() waits for the thread.
/// Under the launcher (CORDIS_LAUNCHED set) time and name are left to the launcher. Then log with
/// spdlog::info(...) and the like.
void install_log(const std::string& name);

/// Logs each line of a text as a line of its own.
void log_lines(spdlog::level::level_enum level, const std::string& text);

}  // namespace cordis::node
