// node/domain_lock.h -- DDS domains of this host, of which each session has its own.
#pragma once

#include <functional>

namespace cordis::node {

// A process holds a domain by a UDP port at the end of the domain's range, which no participant
// reaches. So all users of the host see it, and it ends with the process, whichever way. Who takes
// a port does so while it has the name cordis/domain/N, which one process has at a time: whoever
// looks for a free domain sees all of a change or nothing.

/// Takes a domain that is free: no program of this host, of whatever vendor and user, has a
/// unicast port of it (7400 + 250 domain + 10 and above) on any address.
/// @return a file descriptor that holds the domain until it is closed; -1 when somebody uses it
[[nodiscard]] int lock_domain(int domain) noexcept;

/// Holds a domain that others use, too.
/// @param wanted  asked when no lock can come between any more: whether to hold it at all
/// @return as lock_domain(); -1 also when it is not wanted
[[nodiscard]] int join_domain(int domain, const std::function<bool()>& wanted);

}  // namespace cordis::node
