// node/dds/resending_thread.h -- the priority of the thread by which DDS sends again. Included by
// node/dds and its tests alone.
#pragma once

#include <vector>

#include <sys/types.h>

namespace cordis::dds {

/// The threads of this process, the oldest first; none when /proc does not show them.
std::vector<pid_t> threads_of_process();

/// Takes realtime priority from the thread by which a participant sends again what was lost. That
/// thread never waits for a lock: it tries until it has it. With realtime priority it would keep a
/// core for most of a second from the thread that holds the lock, and all others of lower priority.
/// @param before  threads_of_process() before Fast DDS made the participant: it makes this thread
/// last
void lower_resending_thread(const std::vector<pid_t>& before) noexcept;

}  // namespace cordis::dds
