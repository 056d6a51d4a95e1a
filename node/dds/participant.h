// node/dds/participant.h -- one process' membership of a session.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "idl/control.h"

namespace cordis::dds {

/// Where a process takes part, and as what.
struct ParticipantConfig {
  int domain = 0;         ///< DDS domain, 0..101
  std::string session;    ///< partition: processes of other sessions receive nothing of this one
  std::string node;       ///< name of the node, shown by DDS tools
  bool lockstep = false;  ///< quality of service of the gesture topics
  bool standbys = false;  ///< likewise; the same for all processes of a session
  std::uint32_t wire_version = msg::WIRE_VERSION;  ///< that it speaks; another one in tests alone
};

/// What all that a participant owns begins with, in DDS.
using ParticipantPrefix = std::array<std::uint8_t, 12>;

/// Another participant of the domain.
struct Peer {
  std::string name;  ///< of a Cordis process: SESSION/NODE
  ParticipantPrefix prefix{};
  std::string process;               ///< as process_identity(); of other programs what they say
  std::uint16_t discovery_port = 0;  ///< of 127.0.0.1; 0: it is elsewhere
};

/// A DDS participant on UDP over 127.0.0.1, found and finding others by unicast alone. At most 64
/// share a domain of a host; a process may have several.
///
/// No silence makes a participant drop another: who is there is said by node/status and by the age
/// of samples. It drops those that leave, and within about a second those whose process has ended
/// without leaving.
/// When one that was dropped is there again, as the same, the two would stay deaf to each other:
/// the participant then joins again as another one. Readers and writers stay as they are; samples
/// under way are lost.
///
/// Readers take nothing from a participant that speaks another version of the wire; writers fill in
/// `wire_version` where a message has it.
///
/// Its threads inherit the priority of the thread that makes it.
class Participant {
 public:
  /// @throws std::runtime_error when DDS refuses (domain out of range or full, no loopback
  /// interface, ...).
  explicit Participant(const ParticipantConfig& config);
  /// Its readers and writers are gone before.
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  const ParticipantConfig& config() const noexcept;

  /// The participants that it knows of: of all sessions of the domain, and of those that have ended
  /// some until they are dropped.
  std::vector<Peer> peers() const;

  /// Drops a participant at once, for a caller that knows that its process has ended.
  void drop(const Peer& peer) noexcept;

  /// How often it has joined again.
  std::uint64_t rejoin_count() const noexcept;

  /// Says in a sentence which process of the session cannot be received, or cannot receive, because
  /// it speaks another version of the wire or was started with another launch file; empty while
  /// there is none.
  std::string mismatch() const;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
