// node/dds/participant_ports.h -- the UDP ports of one participant, and those where others are.
// Included by node/dds and its tests alone.
#pragma once

#include <cstdint>
#include <string>

namespace cordis::dds {

/// Participants of one domain that a host has room for. Each announces itself to that many ports of
/// its own host.
inline constexpr int kMaxParticipants = 64;

/// Participants of one domain of a host that other hosts look for: each announces itself to that
/// many ports of each peer.
inline constexpr int kMaxRemoteParticipants = 32;

/// Participants beyond them that only observe: their ports say so, above those of the others.
inline constexpr int kMaxObservers = 8;

/// Ports of a domain [DDSI 9.6.1.1].
inline constexpr int kPortsPerDomain = 250;

/// The first port of a domain, on which a host is reached by multicast [DDSI 9.6.1.1].
std::uint16_t multicast_port(int domain) noexcept;

/// The first port of a domain that belongs to a single participant; the ports above it do, too.
std::uint16_t first_unicast_port(int domain) noexcept;

/// The port of a domain on which participant `index`, 0..kMaxParticipants + kMaxObservers - 1, is
/// discovered [DDSI 9.6.1.1]; the next one takes its samples.
std::uint16_t discovery_port(int domain, int index) noexcept;

/// Participants that observers come after.
constexpr int first_observer(bool is_loopback) noexcept {
  return is_loopback ? kMaxParticipants : kMaxRemoteParticipants;
}

/// Pairs of ports of a domain in all, at one address.
constexpr int pair_count(bool is_loopback) noexcept {
  return first_observer(is_loopback) + kMaxObservers;
}

/// True if a port is that of a participant which only observes.
bool is_of_observer(std::uint16_t port, int domain, bool is_loopback) noexcept;

/// True if this host can bind a socket to address:port.
/// @param address  IPv4, of this host
[[nodiscard]] bool is_free(std::uint16_t port, const std::string& address = "127.0.0.1") noexcept;

/// A pair of ports of an address of this host that is free, held against all other participants of
/// the host for the life of this object.
class ParticipantPorts {
 public:
  /// @param observes  takes one of the pairs of observers, where one of them is free
  /// @throws std::runtime_error when all pairs of the domain are taken.
  ParticipantPorts(int domain, const std::string& address, bool observes = false);
  ~ParticipantPorts();
  ParticipantPorts(const ParticipantPorts&) = delete;
  ParticipantPorts& operator=(const ParticipantPorts&) = delete;

  std::uint16_t discovery() const noexcept { return discovery_; }
  std::uint16_t samples() const noexcept { return static_cast<std::uint16_t>(discovery_ + 1); }

 private:
  [[nodiscard]] bool try_to_take(int domain, const std::string& address, int index) noexcept;

  int lock_ = -1;  // a socket
  std::uint16_t discovery_ = 0;
};

}  // namespace cordis::dds
