// cli/list/domain_sessions.h -- the sessions of a DDS domain, on whatever hosts.
#pragma once

#include <map>
#include <string>

#include "cli/session_address.h"

namespace cordis::cli {

/// The hosts of the nodes of a session, by the names of these.
using NodeHosts = std::map<std::string, std::string>;

/// What is found in a domain.
struct DomainSessions {
  std::map<std::string, NodeHosts> nodes;  ///< the nodes of each session, by its name
  std::string mismatch;  ///< which process cannot be received, and why; empty: none is known
};

/// Finds the sessions of the domain and network of `address` by the statuses of their nodes. Looks
/// for as long as processes take to find each other, at most 5 s for the first.
/// @throws std::runtime_error when DDS refuses
DomainSessions sessions_in_domain(SessionAddress address);

}  // namespace cordis::cli
