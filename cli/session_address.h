// cli/session_address.h -- where a session runs that a person names.
#pragma once

#include <string>

#include "node/dds/network.h"

namespace cordis::cli {

struct SessionAddress {
  std::string session;
  int domain = 0;
  std::string launch_file;  ///< empty when it is not known
  dds::Network network{};
};

/// Where the session is: in the domain of the command line, else where it runs on this host, else
/// in that of its launch file. Its network is that of the session that runs on this host, else what
/// the launch file means here.
/// @param named   a launch file, or the name of a session
/// @param domain, name  what options of the command line say instead; empty where they say nothing
/// @param is_any  the network is that of any session of the domain
/// @throws ConfigError for a bad launch file or option, std::runtime_error when no session, or more
/// than one, runs under that name
SessionAddress address_of(const std::string& named, const std::string& domain,
                          const std::string& name, bool is_any = false);

}  // namespace cordis::cli
