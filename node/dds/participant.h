// node/dds/participant.h -- one process' membership of a session.
#pragma once

#include <array>
#include <chrono>
#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "idl/control.h"
#include "node/dds/network.h"
#include "node/dds/security.h"

namespace cordis::dds {

/// Where a process takes part, and as what.
struct ParticipantConfig {
  int domain = 0;         ///< DDS domain, 0..101
  std::string session;    ///< partition: processes of other sessions receive nothing of this one
  std::string node;       ///< name of the node, shown by DDS tools
  bool lockstep = false;  ///< quality of service of the gesture topics
  bool standbys = false;  ///< likewise; the same for all processes of a session
  std::uint32_t wire_version = msg::WIRE_VERSION;  ///< spoken version; another in tests alone
  bool every_partition = false;  ///< its readers receive from all sessions and all other programs
  Network network{};             ///< equal in all processes of a session on one host
  bool observes = false;         ///< force loops send to it from another thread, 2 ms later
  bool for_loop = false;         ///< a thread that waits on an Arrival takes its samples itself
  Security security{};           ///< on in all processes of a session, or in none
  std::string clock{};  ///< word of the clock of the launch file; empty: it has none to compare
};

/// What all that a participant owns begins with, in DDS.
using ParticipantPrefix = std::array<std::uint8_t, 12>;

/// Another participant of the domain.
struct Peer {
  std::string name;  ///< SESSION/NODE for a Cordis process
  ParticipantPrefix prefix{};
  std::string process;               ///< as process_identity(); of other programs what they say
  std::uint16_t discovery_port = 0;  ///< at the address of this participant; 0: it is elsewhere

  /// True if it is on this host, where its process can be looked up.
  bool is_here() const noexcept { return discovery_port != 0; }
};

/// Looks, one per second, after which a participant of another host that says nothing is dropped.
inline constexpr int kForgottenAfterChecks = 60;

/// How long the writers of a participant wait, all together, for what they wrote last to arrive. A
/// process that ends is to end within the patience of its launcher, whoever has stopped reading.
inline constexpr std::chrono::milliseconds kFarewell{500};

/// A writer of another participant, by its GUID in DDS.
using WriterId = std::array<std::uint8_t, 16>;

/// A topic as a writer offers it. Two that differ in anything here do not share readers.
struct RawTopic {
  std::string name;
  std::string type;  ///< name of its type in DDS: cordis::msg::SceneFrame
  bool keyed = false;
  bool reliable = false;
  bool transient_local = false;
  bool exclusive = false;
  /// A writer of an exclusive one that is silent for so long yields to weaker ones; 0: it never does.
  std::int64_t deadline_nsec = 0;
  auto operator<=>(const RawTopic&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// A writer of another participant.
struct FoundWriter {
  WriterId id{};
  RawTopic topic;
  std::uint32_t strength = 0;  ///< among the writers of the same key of an exclusive topic
  std::vector<std::string> partitions;
};

/// A DDS participant on UDP: without a network over 127.0.0.1 alone, with one through one address of
/// this host. Finds others by unicast, where the network does not say otherwise. At most 64 share a
/// domain of a host, 32 of a session on several hosts; a process may have several.
///
/// Who is there is said by node/status and by the age of samples. A participant drops those that
/// leave, and within about a second those of this host whose process has ended without leaving: no
/// silence makes it drop one of them. Of another host it drops those that have been silent for
/// kForgottenAfterChecks seconds, for there it cannot look at processes.
/// When one that was dropped is there again, as the same, the two would stay deaf to each other:
/// the participant then joins again as another one. Readers and writers stay as they are; samples
/// under way are lost.
///
/// Readers take nothing from a participant that speaks another version of the wire; writers fill in
/// `wire_version` where a message has it.
///
/// A secured participant knows only participants that have proven who they are. It takes no
/// datagram in the clear but what finds and authenticates participants.
///
/// Its threads inherit the priority of the thread that makes it, but for the one that announces it
/// and sends again what was lost: that one has the lowest realtime priority. Who adds or removes
/// readers and writers, or drops a peer, has the priority of its threads meanwhile.
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

  /// True if a participant of the session is on another host, whose clock is not that of this one.
  /// Real time.
  bool has_peers_elsewhere() const noexcept;

  /// Drops a participant at once, for a caller that knows that its process has ended.
  void drop(const Peer& peer) noexcept;

  /// The writers of other participants from which it can receive.
  std::vector<FoundWriter> writers() const;

  /// How often it has joined again.
  std::uint64_t rejoin_count() const noexcept;

  /// Says in a sentence which process of the session cannot be received, or cannot receive; empty
  /// while there is none. It speaks another version of the wire, or was started with another launch
  /// file, or has keys of another keyring.
  std::string mismatch() const;

  struct Impl;
  Impl& impl() noexcept { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::dds
