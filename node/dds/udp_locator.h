// node/dds/udp_locator.h -- an address of UDP as DDS and as the kernel take it.
// Included by node/dds and its tests alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <fastdds/rtps/common/Locator.h>
#include <netinet/in.h>

namespace cordis::dds {

inline constexpr std::size_t kIpv4Begin = 12;  // in the address of a locator [DDSI 9.3.2]

inline sockaddr_in udp_address_of(const eprosima::fastrtps::rtps::Locator_t& locator) noexcept {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(locator.port));
  std::memcpy(&address.sin_addr.s_addr, locator.address + kIpv4Begin,
              sizeof address.sin_addr.s_addr);
  return address;
}

/// Sets port and address of a locator of UDP on IPv4.
inline void set_udp_address(eprosima::fastrtps::rtps::Locator_t& locator,
                            const sockaddr_in& address) noexcept {
  locator.kind = LOCATOR_KIND_UDPv4;
  locator.port = ntohs(address.sin_port);
  std::memcpy(locator.address + kIpv4Begin, &address.sin_addr.s_addr,
              sizeof address.sin_addr.s_addr);
}

}  // namespace cordis::dds
