// node/config/network.h -- `network:` of a launch file: how a session reaches other hosts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "node/config/value.h"

namespace cordis::config {

/// A word of a file, and where it stands there.
struct PlacedText {
  std::string text;
  Place place;
};

/// What a launch file says of the network. It does not depend on the host that reads it:
/// node::network_of() finds what it means on this one.
struct NetworkSection {
  Place place;
  std::optional<PlacedText> interface;  ///< its name, or an address of this host
  std::vector<PlacedText> peers;        ///< hosts of the session: addresses or names
  std::optional<PlacedText> server;     ///< host of a discovery server
  std::uint16_t server_port = 0;
  bool multicast = false;
};

/// True if the text has the form of an IPv4 address.
bool is_ipv4(const std::string& text) noexcept;

/// Reads the mapping `network:`. Problems: unknown keys, peers and servers that are neither an
/// address nor a name of a host, loopback addresses, and a network without any way to find
/// other hosts.
NetworkSection read_network(const Value& value, Problems& problems);

}  // namespace cordis::config
