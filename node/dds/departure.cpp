// node/dds/departure.cpp
#include "node/dds/departure.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/udp_address.h"

namespace cordis::dds {
namespace {

// All numbers are little endian, as the flags of the submessage say.
constexpr std::array<std::uint8_t, 76> kDatagram{
    'R',  'T',  'P',  'S',  2,    3,    0x01, 0x0f,  // version, vendor
    0,    0,    0,    0,    0,    0,    0,    0,     // prefix of the participant
    0,    0,    0,    0,                             //
    0x15, 0x03, 52,   0,                             // DATA with inline QoS, without payload
    0,    0,    16,   0,                             // octets to the inline QoS
    0x00, 0x01, 0x00, 0xc7,                          // to the reader of announcements
    0x00, 0x01, 0x00, 0xc2,                          // from the writer of announcements
    0,    0,    0,    0,    0,    0,    0,    0x40,  // number, beyond that of any announcement
    0x70, 0x00, 16,   0,                             // key: the participant
    0,    0,    0,    0,    0,    0,    0,    0,     //
    0,    0,    0,    0,    0x00, 0x00, 0x01, 0xc1,  //
    0x71, 0x00, 4,    0,    0,    0,    0,    0x03,  // disposed of and unregistered
    0x01, 0x00, 0,    0};                            // end of the list
constexpr std::size_t kSourcePrefix = 8;
constexpr std::size_t kKeyPrefix = 48;

}  // namespace

bool send_departure(const ParticipantPrefix& participant, std::uint16_t port,
                    const std::string& address) noexcept {
  std::array<std::uint8_t, kDatagram.size()> datagram = kDatagram;
  std::ranges::copy(participant, datagram.begin() + kSourcePrefix);
  std::ranges::copy(participant, datagram.begin() + kKeyPrefix);
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  const sockaddr_in place = udp_address(port, ipv4_of(address));
  const auto sent = sendto(file, datagram.data(), datagram.size(), MSG_DONTWAIT,
                           reinterpret_cast<const sockaddr*>(&place), sizeof place);
  close(file);
  return sent == static_cast<ssize_t>(datagram.size());
}

}  // namespace cordis::dds
