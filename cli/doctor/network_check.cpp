// cli/doctor/network_check.cpp
#include "cli/doctor/network_check.h"

#include <algorithm>
#include <filesystem>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/participant_ports.h"
#include "node/dds/socket_buffer.h"
#include "node/session_network.h"

namespace cordis::cli {
namespace {

constexpr int kLargestDomain = 101;

/// A socket of its own, closed at the end.
class Socket {
 public:
  explicit Socket(int type) : file_(socket(AF_INET, type | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (file_ >= 0) close(file_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int file() const noexcept { return file_; }
  bool bind_to(int port) noexcept {
    const sockaddr_in address = loopback(port);
    return bind(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

  static sockaddr_in loopback(int port) noexcept {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

 private:
  int file_;
};

bool datagram_arrives() {
  Socket socket(SOCK_DGRAM);
  if (!socket.bind_to(0)) return false;
  sockaddr_in own{};
  socklen_t size = sizeof own;
  getsockname(socket.file(), reinterpret_cast<sockaddr*>(&own), &size);
  const char byte = 'c';
  if (sendto(socket.file(), &byte, 1, 0, reinterpret_cast<const sockaddr*>(&own), size) != 1)
    return false;
  constexpr int kPatienceMsec = 2000;
  pollfd arrives{socket.file(), POLLIN, 0};
  char received = 0;
  return poll(&arrives, 1, kPatienceMsec) == 1 && recv(socket.file(), &received, 1, 0) == 1;
}

/// Pairs of ports of a domain that are taken, at an address of this host.
int taken_pairs(int domain, int count = dds::pair_count(true),
                const std::string& address = "127.0.0.1") {
  int taken = 0;
  for (int index = 0; index < count; ++index) {
    const std::uint16_t port = dds::discovery_port(domain, index);
    if (!dds::is_free(port, address) ||
        !dds::is_free(static_cast<std::uint16_t>(port + 1), address))
      ++taken;
  }
  return taken;
}

/// 0 when the kernel does not say.
int largest_packet_of(const std::string& interface) {
  const Socket socket(SOCK_DGRAM);
  ifreq request{};
  fmt::format_to_n(request.ifr_name, sizeof request.ifr_name - 1, "{}", interface);
  return ioctl(socket.file(), SIOCGIFMTU, &request) == 0 ? request.ifr_mtu : 0;
}

/// Domain 0 comes last, as in a session that names none.
std::optional<int> free_domain(int other_than) {
  for (int i = 1; i <= kLargestDomain + 1; ++i) {
    const int domain = i % (kLargestDomain + 1);
    if (domain != other_than && taken_pairs(domain) == 0) return domain;
  }
  return std::nullopt;
}

bool page_port_is_free(int port) {
  Socket socket(SOCK_STREAM);
  const int yes = 1;
  setsockopt(socket.file(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  return socket.bind_to(port) && listen(socket.file(), 1) == 0;
}

}  // namespace

Finding check_loopback() {
  Finding finding{.key = "network.loopback", .title = "loopback"};
  const bool works = datagram_arrives();
  finding.values = {{"works", works}};
  finding.text = "a datagram sent to 127.0.0.1 arrives";
  if (works) return finding;
  finding.level = Level::kUnusable;
  finding.text = "a datagram sent to 127.0.0.1 does not arrive: no node finds another";
  finding.advice = "bring the loopback interface up";
  finding.commands = {"sudo ip link set lo up"};
  return finding;
}

Finding check_socket_buffers() {
  Finding finding{.key = "network.buffers", .title = "socket buffers"};
  const std::uint32_t receive = dds::granted_bytes(dds::SocketBuffer::kReceive);
  const std::uint32_t send = dds::granted_bytes(dds::SocketBuffer::kSend);
  finding.values = {
      {"receive_bytes", receive}, {"send_bytes", send}, {"wanted_bytes", dds::kSocketBufferBytes}};
  finding.text = fmt::format("{} KiB to receive, {} KiB to send", receive / 1024, send / 1024);
  if (std::min(receive, send) >= dds::kSocketBufferBytes) return finding;
  finding.level = Level::kWarning;
  finding.text += fmt::format(
      ", of {} KiB wanted: large scenes lose frames (net.core.rmem_max, net.core.wmem_max)",
      dds::kSocketBufferBytes / 1024);
  finding.advice = "allow larger ones; a line in /etc/sysctl.d keeps it";
  finding.commands = {fmt::format("sudo sysctl -w net.core.rmem_max={0} net.core.wmem_max={0}",
                                  dds::kSocketBufferBytes)};
  return finding;
}

Finding check_dds_ports(int domain) {
  Finding finding{.key = "network.dds_ports", .title = "DDS ports"};
  const int taken = taken_pairs(domain);
  finding.values = {{"domain", domain}, {"taken", taken}, {"checked", dds::pair_count(true)}};
  finding.text = fmt::format("those of domain {} are free", domain);
  if (taken == 0) return finding;
  finding.level = Level::kWarning;
  finding.text = fmt::format(
      "{} of {} pairs of domain {} are taken, by a session that runs or by another program", taken,
      dds::pair_count(true), domain);
  const std::optional<int> other = free_domain(domain);
  if (!other) return finding;
  finding.values["free_domain"] = *other;
  finding.advice =
      fmt::format("if that is not a session of yours, use another: run with domain={}", *other);
  return finding;
}

Finding check_interface(const std::string& wanted, int domain) {
  constexpr int kMinPacket = 1428;  // the largest datagram of a session with its headers
  Finding finding{.key = "network.interface", .title = "interface"};
  const std::vector<node::HostInterface> interfaces = node::host_interfaces();
  std::string names;
  nlohmann::json all = nlohmann::json::array();
  for (const node::HostInterface& one : interfaces) {
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", one.name, one.address);
    all.push_back({{"name", one.name}, {"address", one.address}});
  }
  finding.values = {{"interfaces", all}};
  const auto found = std::ranges::find_if(interfaces, [&](const node::HostInterface& one) {
    return one.name == wanted || one.address == wanted;
  });
  if (found == interfaces.end()) {
    finding.text = names.empty() ? "none besides loopback: sessions stay on this host"
                                 : "a session on several hosts may use " + names;
    if (wanted.empty()) return finding;
    finding.level = Level::kWarning;
    finding.text = fmt::format("'{}' is no interface that is up with an IPv4 address", wanted);
    finding.advice = names.empty() ? "bring it up" : "name one of " + names;
    return finding;
  }
  const int packet = largest_packet_of(found->name);
  const int taken = taken_pairs(domain, dds::pair_count(false), found->address);
  const bool wireless = std::filesystem::exists("/sys/class/net/" + found->name + "/wireless");
  finding.values.update({{"name", found->name},
                         {"address", found->address},
                         {"largest_packet_bytes", packet},
                         {"wireless", wireless},
                         {"link", found->has_link},
                         {"domain", domain},
                         {"taken", taken}});
  finding.text =
      fmt::format("{} ({}), ports of domain {} are free", found->name, found->address, domain);
  if (taken > 0)
    finding.text = fmt::format("{} ({}), {} of {} pairs of ports of domain {} are taken",
                               found->name, found->address, taken, dds::pair_count(false), domain);
  if (taken > 0) finding.advice = "if that is not a session of yours, use another domain";
  if (packet < kMinPacket) {
    finding.text += fmt::format("; packets of {} bytes at most", packet);
    finding.advice = "datagrams are sent in parts, and lost with any of them";
    finding.commands = {fmt::format("sudo ip link set {} mtu 1500", found->name)};
  }
  if (!found->has_link) {
    finding.text += "; no link";
    finding.advice = "put its cable in: no session starts on it";
  }
  if (wireless) {
    finding.text += "; wireless";
    finding.advice = "use a cable: over the air samples are lost and late";
  }
  if (!finding.advice.empty()) finding.level = Level::kWarning;
  return finding;
}

Finding check_page_port(int port) {
  constexpr int kLargestPort = 65535;
  Finding finding{.key = "page.port", .title = "port of the page"};
  const bool is_free = page_port_is_free(port);
  finding.values = {{"port", port}, {"free", is_free}};
  finding.text = fmt::format("{} is free", port);
  if (is_free) return finding;
  finding.level = Level::kWarning;
  finding.text = fmt::format("{} is in use, by a session that runs or by another program", port);
  int other = port;
  while (other < kLargestPort && !page_port_is_free(other)) ++other;
  finding.values["free_port"] = other;
  finding.advice = fmt::format("give the page another one: run with view.port={}", other);
  return finding;
}

}  // namespace cordis::cli
