// cli/info/session_info.h -- the topics of a running session, and who writes them.
#pragma once

#include <string>

namespace cordis::cli {

/// The topics of a session with their types, quality of service, writers and schemas, as text.
/// Looks for as long as processes take to find each other, at most 5 s for the first.
/// @param pattern  of topics; empty: all
/// @throws std::runtime_error when no such session runs, or no process writes in it
std::string session_text(const std::string& session, const std::string& pattern,
                         const std::string& domain);

}  // namespace cordis::cli
