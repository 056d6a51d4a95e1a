// node/dds/udp_address.h -- a UDP port of this host, as the kernel takes it.
#pragma once

#include <cstdint>

#include <netinet/in.h>

namespace cordis::dds {

/// @param host  in host order: 127.0.0.1, or INADDR_ANY to bind to every address
inline sockaddr_in udp_address(std::uint16_t port, in_addr_t host = INADDR_LOOPBACK) noexcept {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(host);
  return address;
}

}  // namespace cordis::dds
