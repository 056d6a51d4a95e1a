// node/dds/udp_address.h -- a UDP port of this host, as the kernel takes it.
#pragma once

#include <cstdint>
#include <string>

#include <arpa/inet.h>
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

/// An IPv4 address as people write it, in host order; INADDR_NONE if it is none.
inline in_addr_t ipv4_of(const std::string& text) noexcept {
  in_addr read{};
  return inet_pton(AF_INET, text.c_str(), &read) == 1 ? ntohl(read.s_addr) : INADDR_NONE;
}

}  // namespace cordis::dds
