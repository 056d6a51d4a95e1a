// node/domain_lock.cpp
#include "node/domain_lock.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/participant_ports.h"
#include "node/dds/udp_address.h"
#include "node/instance_lock.h"

namespace cordis::node {
namespace {

constexpr int kMaxHolders = 100;
constexpr std::chrono::seconds kPatience{5};

/// @return a socket that has the port; -1 when another one does.
int take_port(int port, in_addr_t address_to_bind) noexcept {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return -1;
  const sockaddr_in address = dds::udp_address(static_cast<std::uint16_t>(port), address_to_bind);
  if (bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return file;
  close(file);
  return -1;
}

int end_of_ports(int domain) noexcept {
  return dds::multicast_port(domain) + dds::kPortsPerDomain;
}

bool all_ports_are_free(int domain) noexcept {
  const int end = end_of_ports(domain);
  for (int port = dds::first_unicast_port(domain); port < end; ++port) {
    const int file = take_port(port, INADDR_ANY);
    if (file < 0) return false;
    close(file);
  }
  return true;
}

int hold(int domain) noexcept {
  const int last = end_of_ports(domain) - 1;
  for (int port = last; port > last - kMaxHolders; --port) {
    const int file = take_port(port, INADDR_LOOPBACK);
    if (file >= 0) return file;
  }
  return -1;
}

int try_to_take_turn(int domain) noexcept {
  char name[32];
  std::snprintf(name, sizeof name, "cordis/domain/%d", domain);
  return try_to_lock(name);
}

}  // namespace

int lock_domain(int domain) noexcept {
  const int turn = try_to_take_turn(domain);
  if (turn < 0) return -1;
  const int file = all_ports_are_free(domain) ? hold(domain) : -1;
  close(turn);
  return file;
}

int join_domain(int domain, const std::function<bool()>& wanted) {
  int turn = try_to_take_turn(domain);
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (turn < 0 && std::chrono::steady_clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    turn = try_to_take_turn(domain);
  }
  const int file = wanted() ? hold(domain) : -1;
  if (turn >= 0) close(turn);
  return file;
}

}  // namespace cordis::node
