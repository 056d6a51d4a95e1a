// node/config/network.cpp
#include "node/config/network.h"

#include <algorithm>

#include "node/config/number.h"

namespace cordis::config {
namespace {

constexpr std::size_t kLongestHost = 253;
constexpr std::size_t kMaxPeers = 16;
constexpr const char* kOneHost = "leave 'network:' out for a session on one host";

bool is_host(const std::string& text) {
  const auto fits = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-';
  };
  if (text.empty() || text.size() > kLongestHost || !std::all_of(text.begin(), text.end(), fits))
    return false;
  // What looks like an address has to be one.
  const bool is_numeric = text.find_first_not_of("0123456789.") == std::string::npos;
  return is_numeric ? is_ipv4(text) : text.front() != '-' && text.front() != '.';
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || (is_ipv4(host) && host.starts_with("127."));
}

/// @return false after a problem
bool check_host(MappingReader& reader, const std::string& key, const PlacedText& host,
                Problems& problems) {
  if (!is_host(host.text)) {
    problems.error(host.place, reader.what() + "." + key + ": '" + host.text +
                                   "' is neither an IPv4 address nor the name of a host");
    return false;
  }
  if (is_loopback(host.text)) {
    problems.error(host.place,
                   reader.what() + "." + key + ": " + host.text +
                       " is the loopback interface, which no other host reaches",
                   kOneHost);
    return false;
  }
  return true;
}

void read_peers(MappingReader& reader, NetworkSection& network, Problems& problems) {
  const Value peers = reader.optional_sequence("peers");
  for (const Value& item : peers.items()) {
    if (item.kind() != Value::Kind::kScalar) {
      problems.error(item.place(), "network.peers: expected an address or the name of a host");
      continue;
    }
    const PlacedText peer{item.text(), item.place()};
    if (check_host(reader, "peers", peer, problems)) network.peers.push_back(peer);
  }
  if (peers.exists() && peers.items().empty())
    reader.error_at("peers", "network.peers names no host");
  if (network.peers.size() > kMaxPeers)
    reader.error_at(
        "peers", "network.peers has at most 16 hosts, got " + std::to_string(network.peers.size()));
}

void read_server(MappingReader& reader, NetworkSection& network, Problems& problems) {
  const std::string text = reader.optional_text("discovery_server", "");
  if (!reader.has("discovery_server") || !reader.ok()) return;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool is_number = !port.empty() && port.size() <= 5 &&
                         port.find_first_not_of("0123456789") == std::string::npos;
  const int number = is_number ? std::stoi(port) : 0;
  if (number < 1 || number > 65535) {
    reader.error_at(
        "discovery_server",
        "network.discovery_server is ADDRESS:PORT with a port of 1 to 65535, got '" + text + "'",
        "discovery_server: 192.168.5.1:11811");
    return;
  }
  const PlacedText server{text.substr(0, colon), reader.place_of("discovery_server")};
  if (!check_host(reader, "discovery_server", server, problems)) return;
  network.server = server;
  network.server_port = static_cast<std::uint16_t>(number);
}

}  // namespace

bool is_ipv4(const std::string& text) noexcept {
  int numbers = 0;
  for (std::size_t start = 0; start <= text.size(); ++numbers) {
    const std::size_t end = std::min(text.find('.', start), text.size());
    const std::size_t length = end - start;
    int value = 0;
    for (std::size_t i = start; i < end; ++i) {
      if (text[i] < '0' || text[i] > '9') return false;
      value = 10 * value + (text[i] - '0');
      if (value > 255) return false;
    }
    if (length == 0 || (length > 1 && text[start] == '0')) return false;
    start = end + 1;
  }
  return numbers == 4;
}

NetworkSection read_network(const Value& value, Problems& problems) {
  NetworkSection network;
  network.place = value.place();
  MappingReader reader(value, "network", problems);
  const PlacedText name{reader.optional_text("interface", ""), reader.place_of("interface")};
  if (reader.has("interface") && reader.ok()) {
    if (name.text == "lo" || is_loopback(name.text)) {
      reader.error_at("interface",
                      "network.interface: " + name.text +
                          " is the loopback interface, which no other host reaches",
                      kOneHost);
    } else if (name.text.find_first_not_of("0123456789.") == std::string::npos &&
               !is_ipv4(name.text)) {
      reader.error_at("interface", "network.interface: '" + name.text +
                                       "' is neither an IPv4 address nor the name of an interface");
    }
    network.interface = name;
  }
  read_peers(reader, network, problems);
  read_server(reader, network, problems);
  network.multicast = reader.optional_truth("multicast", false);
  if (network.server && (network.multicast || reader.has("peers")))
    reader.error_at("discovery_server",
                    "network.discovery_server finds all others by itself: no 'peers' and no "
                    "'multicast' beside it");
  reader.finish();
  if (!reader.ok()) return network;
  if (!reader.has("peers") && !network.server && !network.multicast) {
    problems.error(network.place,
                   "network names no other host: it needs 'peers', 'discovery_server' or "
                   "'multicast: true'",
                   "peers: [192.168.5.1, 192.168.5.2], all hosts of the session");
  } else if (network.multicast && !reader.has("peers") && !network.interface) {
    problems.error(network.place, "network.multicast without 'peers' needs 'interface'",
                   "interface: eth0");
  }
  return network;
}

}  // namespace cordis::config
