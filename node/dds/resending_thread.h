// node/dds/resending_thread.h -- the priority of the thread by which DDS sends again. Included by
// node/dds and its tests alone.
#pragma once

#include <vector>

#include <sys/types.h>

namespace cordis::dds {

/// The threads of this process, the oldest first; none when /proc does not show them.
std::vector<pid_t> threads_of_process();

/// Gives the lowest realtime priority to the thread by which a participant announces itself and
/// sends again what was lost, and the name "dds-resend". The thread never waits for a lock of a
/// writer. It tries until it has it, and keeps a core for most of a second from a thread of lower
/// priority that holds the lock. So whoever takes such a lock has a higher one (Participant::Impl).
/// The thread shares the lock by which the participant sends with the force loop, which ordinary
/// priority would hold up. Nothing changes where the threads have ordinary priority.
/// @param before  threads_of_process() before Fast DDS made the participant: it makes this thread
/// last
void lower_resending_thread(const std::vector<pid_t>& before) noexcept;

}  // namespace cordis::dds
