// cli/doctor/network_check.h -- sockets and ports.
#pragma once

#include <string>

#include "cli/doctor/finding.h"

namespace cordis::cli {

/// network.loopback: sends a datagram to itself over 127.0.0.1.
Finding check_loopback();
/// network.buffers: asks for the size that DDS asks for.
Finding check_socket_buffers();
/// network.dds_ports of a domain, 0..101
Finding check_dds_ports(int domain);
/// network.interface: what a session on several hosts can use.
/// @param wanted  name or address; empty: those that there are are named
Finding check_interface(const std::string& wanted, int domain);
/// page.port
Finding check_page_port(int port);

}  // namespace cordis::cli
