// node/dds/network.h -- through which address of this host a participant speaks, and with whom.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::dds {

/// True for an IPv4 address of loopback, 127.0.0.0/8: Debian gives the name of a host 127.0.1.1.
inline bool is_loopback(std::string_view address) noexcept {
  return address.starts_with("127.");
}

/// The network of a participant. As it is made: this host alone, on loopback.
struct Network {
  std::string address = "127.0.0.1";  ///< IPv4 address of this host: what its sockets are bound to
  std::vector<std::string> peers;     ///< other hosts, IPv4
  std::string server;                 ///< IPv4 of a discovery server; empty: none
  std::uint16_t server_port = 0;
  bool multicast = false;  ///< announces itself on 239.255.0.1, and is found there

  bool operator==(const Network&) const = default;

  /// True if no datagram leaves this host, and none comes from outside.
  bool is_loopback() const noexcept { return dds::is_loopback(address); }
};

}  // namespace cordis::dds
