// tests/support/datagrams.cpp
#include "tests/support/datagrams.h"

#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/participant_ports.h"
#include "node/dds/udp_address.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis::test {

std::optional<Datagram> an_announcement() {
  const dds::ParticipantPorts ports(own_domain(), "127.0.0.1");
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in place = dds::udp_address(ports.discovery());
  std::optional<Datagram> found;
  if (bind(file, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
    eventually([&] {
      Datagram datagram(65'536);
      const ssize_t size = recv(file, datagram.data(), datagram.size(), MSG_DONTWAIT);
      if (size <= 0) return false;
      datagram.resize(static_cast<std::size_t>(size));
      found = datagram;
      return true;
    });
  }
  close(file);
  return found;
}

void send_to_all(const Datagram& datagram) {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  for (int index = 0; index < dds::kMaxParticipants + dds::kMaxObservers; ++index) {
    const std::uint16_t discovery = dds::discovery_port(own_domain(), index);
    for (const std::uint16_t port : {discovery, static_cast<std::uint16_t>(discovery + 1)}) {
      const sockaddr_in place = dds::udp_address(port);
      sendto(file, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&place),
             sizeof place);
    }
  }
  close(file);
}

}  // namespace cordis::test
