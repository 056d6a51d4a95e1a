// cli/duration.h -- a span of time as a person types it.
#pragma once

#include <chrono>
#include <string>

namespace cordis::cli {

/// Reads a number and a unit without a space between them: 500ms, 10s, 1.5s, 2min, 1h.
/// @throws UsageError when the text is anything else, not longer than 0, or longer than 10000 h.
std::chrono::nanoseconds parse_duration(const std::string& text);

/// As parse_duration(), for the distance from a beginning: 0 and 0s are taken, too.
/// @throws UsageError when the text is anything else, below 0, or longer than 10000 h.
std::chrono::nanoseconds parse_offset(const std::string& text);

/// The span as a number [s].
double seconds_of(std::chrono::nanoseconds span) noexcept;

/// The span in seconds, as short as it can be written without loss: "10", "0.5".
std::string in_seconds(std::chrono::nanoseconds duration);

}  // namespace cordis::cli
