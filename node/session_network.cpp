// node/session_network.cpp
#include "node/session_network.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/config/nearest_word.h"
#include "node/dds/participant_ports.h"
#include "node/dds/udp_address.h"

namespace cordis::node {
namespace {

std::string text_of(const sockaddr_in& address) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &address.sin_addr, text, sizeof text);
  return text;
}

std::string listed(const std::vector<HostInterface>& interfaces) {
  std::string text;
  for (const HostInterface& interface : interfaces)
    text += (text.empty() ? "" : ", ") + interface.name + " (" + interface.address + ")";
  return text.empty() ? "it has none besides loopback" : "it has " + text;
}

bool has_address(const std::vector<HostInterface>& interfaces, const std::string& address) {
  return std::any_of(interfaces.begin(), interfaces.end(),
                     [&](const HostInterface& own) { return own.address == address; });
}

/// The IPv4 address of a host; nothing after a problem.
std::optional<std::string> address_of(const config::PlacedText& host, config::Problems& problems) {
  if (config::is_ipv4(host.text)) return host.text;
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.text.c_str(), nullptr, &wanted, &found);
  if (error != 0 || found == nullptr) {
    problems.error(host.place, "no host '" + host.text + "' is known here: " + gai_strerror(error),
                   "write its IPv4 address");
    return std::nullopt;
  }
  const std::string address = text_of(*reinterpret_cast<const sockaddr_in*>(found->ai_addr));
  freeaddrinfo(found);
  return address;
}

/// The address of this host from which the kernel sends to another one. Nothing is sent.
std::optional<std::string> source_towards(const std::string& address) {
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return std::nullopt;
  const sockaddr_in there = dds::udp_address(dds::multicast_port(0), dds::ipv4_of(address));
  sockaddr_in own{};
  socklen_t size = sizeof own;
  const bool found = connect(file, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0 &&
                     getsockname(file, reinterpret_cast<sockaddr*>(&own), &size) == 0;
  close(file);
  if (!found) return std::nullopt;
  return text_of(own);
}

/// Fast DDS takes no interface without a link, not even when the link comes later. No fault of the
/// file: a node that starts again may find it.
void check_link(const HostInterface& interface, const config::Place& place) {
  if (interface.has_link) return;
  config::Problem problem;
  problem.place = place;
  problem.message =
      "interface " + interface.name + " (" + interface.address + ") has no link: is its cable in?";
  throw std::runtime_error(problem.text());
}

/// @return the address that the sockets are bound to; empty after a problem
std::string own_address(const config::NetworkSection& section, const config::PlacedText* other,
                        const std::string& other_address, config::Problems& problems) {
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (!section.interface) {
    const std::optional<std::string> source = source_towards(other_address);
    for (const HostInterface& interface : interfaces) {
      if (interface.address != source) continue;
      check_link(interface, other->place);
      return interface.address;
    }
    problems.error(other->place, "this host has no way to " + other->text,
                   listed(interfaces) + "; name one with network.interface");
    return {};
  }
  const std::string& word = section.interface->text;
  std::vector<std::string> names;
  for (const HostInterface& interface : interfaces) {
    if (interface.name == word || interface.address == word) {
      check_link(interface, section.interface->place);
      return interface.address;
    }
    names.push_back(interface.name);
  }
  const std::string near = config::did_you_mean(word, names);
  problems.error(section.interface->place,
                 config::is_ipv4(word)
                     ? word + " is no address of this host"
                     : "this host has no interface '" + word + "' that is up with an IPv4 address",
                 near.empty() ? listed(interfaces) : near + " " + listed(interfaces));
  return {};
}

}  // namespace

std::vector<HostInterface> host_interfaces() {
  std::vector<HostInterface> found;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool counts = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
                        (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (counts)
      found.push_back({one->ifa_name, text_of(*reinterpret_cast<sockaddr_in*>(one->ifa_addr)),
                       (one->ifa_flags & IFF_RUNNING) != 0});
  }
  freeifaddrs(all);
  return found;
}

dds::Network network_of(const config::Launch& launch, config::Problems& problems) {
  dds::Network network;
  if (!launch.network) return network;
  const config::NetworkSection& section = *launch.network;
  config::check_domain(launch, problems);
  const config::PlacedText* first = nullptr;  // of the others
  std::string first_address;
  bool is_known = true;  // every host
  const auto resolve = [&](const config::PlacedText& host) {
    const std::optional<std::string> address = address_of(host, problems);
    if (address && first == nullptr && !dds::is_loopback(*address)) {
      first = &host;
      first_address = *address;
    }
    return address.value_or("");
  };
  for (const config::PlacedText& peer : section.peers) {
    const std::string address = resolve(peer);
    is_known = is_known && !address.empty();
    if (!address.empty() && !dds::is_loopback(address)) network.peers.push_back(address);
  }
  const std::vector<HostInterface> interfaces = host_interfaces();
  if (section.server) {
    network.server = resolve(*section.server);
    // It reaches programs of its own host over loopback, where a session on a network has no
    // socket.
    is_known = is_known && !network.server.empty();
    if (dds::is_loopback(network.server) || has_address(interfaces, network.server))
      problems.error(section.server->place,
                     "the discovery server must not run on a host of the session, and " +
                         network.server + " is an address of this one",
                     "start it on another host, or name 'peers' instead");
  }
  network.server_port = section.server_port;
  network.multicast = section.multicast;
  if (!section.interface && first == nullptr) {
    if (is_known && !section.server)
      problems.error(section.peers.front().place,
                     "every peer is this host itself: nothing names the interface of the session",
                     listed(interfaces) + "; name one with network.interface");
    return network;
  }
  network.address = own_address(section, first, first_address, problems);
  std::erase_if(network.peers,
                [&](const std::string& peer) { return has_address(interfaces, peer); });
  return network;
}

std::string network_line(const dds::Network& network) {
  if (network.is_loopback()) return {};
  std::string line = network.address + (network.multicast ? " multicast" : " unicast");
  if (!network.server.empty())
    line += " server " + network.server + ' ' + std::to_string(network.server_port);
  if (!network.peers.empty()) line += " peers";
  for (const std::string& peer : network.peers) line += ' ' + peer;
  return line;
}

dds::Network network_of_line(const std::string& line) {
  dds::Network network;
  std::istringstream words(line);
  std::string cast;
  if (!(words >> network.address >> cast)) return {};
  network.multicast = cast == "multicast";
  std::string word;
  words >> word;
  if (word == "server") words >> network.server >> network.server_port >> word;
  if (word == "peers") {
    while (words >> word) network.peers.push_back(word);
  }
  return network;
}

std::string exposure_warning(const dds::Network& network, int domain, bool is_secured) {
  if (network.is_loopback()) return {};
  const std::string where =
      network.address + " (UDP ports of DDS domain " + std::to_string(domain) + ")";
  if (is_secured)
    return "whoever reaches " + where + " sees who takes part, and can disturb the session";
  return "this session is open to everybody who reaches " + where +
         ": nothing is encrypted and no password is asked for";
}

}  // namespace cordis::node
