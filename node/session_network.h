// node/session_network.h -- what `network:` of a launch file means on this host.
#pragma once

#include <string>
#include <vector>

#include "node/config/launch.h"
#include "node/dds/network.h"

namespace cordis::node {

/// An interface of this host that is up, with one of its IPv4 addresses.
struct HostInterface {
  std::string name;
  std::string address;
  bool has_link = true;  ///< false: no cable, say
};

/// Interfaces of this host but loopback, in the order of the kernel.
std::vector<HostInterface> host_interfaces();

/// The network of a session on this host: loopback without `network:`. Without `interface` it is
/// the interface through which the kernel reaches the first peer or the server; own addresses among the
/// peers are left out, and names that are loopback here: Debian makes its own name one. Names of
/// hosts are looked up, which takes as long as it takes. Problems: no `domain`, an interface or
/// address that this host has not, a host whose name is not known, a peer that is not reached, and a
/// server on this host.
/// @throws std::runtime_error when the interface has no link.
[[nodiscard]] dds::Network network_of(const config::Launch& launch, config::Problems& problems);

/// One line for a file, and back: "10.0.0.1 multicast server 10.0.0.9 11811 peers 10.0.0.2".
std::string network_line(const dds::Network& network);
/// Loopback for an empty line.
dds::Network network_of_line(const std::string& line);

/// What a person must know when a session starts on a network; empty on loopback.
/// @param is_secured  its participants have keys
std::string exposure_warning(const dds::Network& network, int domain, bool is_secured);

}  // namespace cordis::node
