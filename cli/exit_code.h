// cli/exit_code.h -- what the `cordis` program ends with. 128 + signal stands for a node killed by
// that signal.
#pragma once

namespace cordis::cli {

inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;   ///< something went wrong while it ran
inline constexpr int kBadInput = 2;  ///< a file or the command line is wrong; nothing was started
inline constexpr int kLoss = 3;      ///< done, but something was damaged or lost

}  // namespace cordis::cli
