// node/dds/participant_ports.cpp
#include "node/dds/participant_ports.h"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "node/dds/network.h"
#include "node/dds/udp_address.h"

namespace cordis::dds {
namespace {

constexpr int kFirstPort = 7400;
constexpr int kFirstUnicast = 10;  // of a domain

/// Two processes that start together find the same port free: one of them holds the name.
/// @return a socket, or -1 when another process holds it
int try_to_hold(std::uint16_t port) noexcept {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // The leading zero makes the name abstract: it lives as long as the socket, and leaves no file.
  const int length = std::snprintf(address.sun_path + 1, sizeof address.sun_path - 1,
                                   "cordis/dds/port/%d", static_cast<int>(port));
  const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (file < 0) return -1;
  const auto size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1) + static_cast<socklen_t>(length);
  if (bind(file, reinterpret_cast<const sockaddr*>(&address), size) == 0) return file;
  close(file);
  return -1;
}

}  // namespace

std::uint16_t multicast_port(int domain) noexcept {
  return static_cast<std::uint16_t>(kFirstPort + kPortsPerDomain * domain);
}

std::uint16_t first_unicast_port(int domain) noexcept {
  return static_cast<std::uint16_t>(multicast_port(domain) + kFirstUnicast);
}

std::uint16_t discovery_port(int domain, int index) noexcept {
  return static_cast<std::uint16_t>(first_unicast_port(domain) + 2 * index);
}

bool has_address(const std::string& address) noexcept {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return true;
  const sockaddr_in place = udp_address(0, ipv4_of(address));  // any port
  const bool bound = bind(file, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  const bool absent = !bound && errno == EADDRNOTAVAIL;
  close(file);
  return !absent;
}

bool is_free(std::uint16_t port, const std::string& address) noexcept {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  const sockaddr_in place = udp_address(port, ipv4_of(address));
  const bool free = bind(file, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  close(file);
  return free;
}

bool is_of_observer(std::uint16_t port, int domain, bool is_loopback) noexcept {
  const int first = first_observer(is_loopback);
  return port >= discovery_port(domain, first) &&
         port < discovery_port(domain, first + kMaxObservers);
}

bool ParticipantPorts::try_to_take(int domain, const std::string& address, int index) noexcept {
  discovery_ = discovery_port(domain, index);
  lock_ = try_to_hold(discovery_);
  if (lock_ < 0) return false;
  if (is_free(discovery_, address) && is_free(samples(), address)) return true;
  close(lock_);
  return false;
}

ParticipantPorts::ParticipantPorts(int domain, const std::string& address, bool observes) {
  // A participant with a higher number would be looked for by no other host.
  const int count = first_observer(is_loopback(address));
  for (int index = count; observes && index < count + kMaxObservers; ++index) {
    if (try_to_take(domain, address, index)) return;
  }
  for (int index = 0; index < count; ++index) {
    if (try_to_take(domain, address, index)) return;
  }
  if (!has_address(address))
    throw std::runtime_error(address +
                             " is no address of this host any more: its interface has lost it");
  throw std::runtime_error("DDS domain " + std::to_string(domain) + " of this host is full: all " +
                           std::to_string(count) + " pairs of UDP ports, " + address + ":" +
                           std::to_string(discovery_port(domain, 0)) + " to " +
                           std::to_string(discovery_port(domain, count - 1) + 1) +
                           ", are taken; end processes of it, or take another one with domain=N");
}

ParticipantPorts::~ParticipantPorts() {
  close(lock_);
}

}  // namespace cordis::dds
