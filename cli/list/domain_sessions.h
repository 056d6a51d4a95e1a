// cli/list/domain_sessions.h -- the sessions of a DDS domain, on whatever hosts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/session_address.h"

namespace cordis::cli {

/// A node of a session, as its status names it.
struct ListedNode {
  std::string node;
  std::string host;
};

/// Finds the sessions of the domain and network of `address` by the statuses of their nodes. Looks
/// for as long as processes take to find each other, at most 5 s for the first.
/// @return nodes in the order of their names, by session
/// @throws std::runtime_error when DDS refuses
std::map<std::string, std::vector<ListedNode>> sessions_in_domain(SessionAddress address);

}  // namespace cordis::cli
