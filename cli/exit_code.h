// cli/exit_code.h -- what the `cordis` program ends with. 128 + signal tells of a node killed by
// that signal.
#pragma once

namespace cordis::cli {

inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;   ///< something went wrong while it ran
inline constexpr int kBadInput = 2;  ///< a file or the command line is wrong; nothing was started

}  // namespace cordis::cli
