// cli/bench/turns.h -- times of several pieces of work, measured in turns.
#pragma once

#include <functional>
#include <vector>

namespace cordis::cli {

/// Measures each piece of work in turns, so that whatever slows the machine for a while slows all
/// of them. A turn lasts 20 ms at least.
/// @param work    each does one unit of work when called
/// @param rounds  turns of each, > 0
/// @return the median time of a call of each [s], in the processor time of this thread
std::vector<double> times_in_turns(const std::vector<std::function<void()>>& work, int rounds);

}  // namespace cordis::cli
