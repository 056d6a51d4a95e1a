// node/dds/presence.h -- one participant of Fast DDS: how others see a process. Included by
// node/dds alone.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "node/dds/participant.h"
#include "node/dds/participant_ports.h"
#include "node/dds/topics.h"
#include "node/dds/udp_transport.h"
#include "node/dds/wire_version.h"

namespace cordis::dds {

namespace fast = eprosima::fastdds::dds;

WriterId writer_id(const eprosima::fastrtps::rtps::GUID_t& guid);

/// A DDS participant with publisher and subscriber, and what it knows of the others of its domain.
class Presence final : public fast::DomainParticipantListener {
 public:
  /// @param peers_elsewhere  set to the number of participants of the session on other hosts
  /// @param on_return  called from a thread of DDS when a participant that was dropped is there
  /// again. The two do not receive each other then: see Participant.
  /// @throws std::runtime_error when DDS refuses.
  Presence(const ParticipantConfig& config, std::atomic<int>& peers_elsewhere,
           std::function<void()> on_return);
  /// Where a loop takes the samples; null if DDS takes them.
  const std::shared_ptr<SampleSocket>& samples() const noexcept { return link_->samples; }

  /// Deletes all readers and writers too.
  ~Presence() override;
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  fast::Publisher& publisher() noexcept { return *publisher_; }
  fast::Subscriber& subscriber() noexcept { return *subscriber_; }

  /// The topic of the table, made at its first use. `type` is registered when its name is new.
  fast::Topic* topic(const TopicQos& row, fast::TypeSupport type);

  /// The topic of any type, made at its first use.
  /// @throws std::runtime_error when this participant uses its name with another type.
  fast::Topic* topic(const std::string& name, fast::TypeSupport type);

  std::vector<Peer> peers() const;
  std::vector<FoundWriter> writers() const;
  /// Nothing when it is not known (any more).
  std::optional<FoundWriter> writer(const WriterId& id) const;
  std::string mismatch() const;
  /// True unless the participant is known to be on another host. Takes a lock.
  bool is_here(const ParticipantPrefix& participant) const;

  /// A participant of the session has said that it speaks this version of the wire.
  void evaluate(const ParticipantPrefix& participant, std::uint32_t wire_version);
  /// True if messages of a participant are refused. Real time.
  bool refuses(const ParticipantPrefix& participant) const noexcept {
    return has_other_wire_version(participant, config_.wire_version);
  }

  /// Drops each participant whose process has ended without leaving: it would cost its share of
  /// every message, for DDS itself forgets no process. Of another host: that has been silent for
  /// kForgottenAfterChecks calls. Called once a second: a process that has itself been stopped makes
  /// no calls, and so holds no other for silent.
  void drop_who_is_gone() noexcept;
  void drop(const Peer& peer) noexcept;

  void on_participant_discovery(
      fast::DomainParticipant*,
      eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& found) override;
  void onParticipantAuthentication(
      fast::DomainParticipant*,
      eprosima::fastrtps::rtps::ParticipantAuthenticationInfo&& info) override;
  void on_publisher_discovery(fast::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override;
  void on_subscriber_discovery(fast::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& found) override;

 private:
  using Guid = eprosima::fastrtps::rtps::GUID_t;

  /// A participant, and what Fast DDS records of it.
  struct Known {
    Peer peer;
    const eprosima::fastrtps::rtps::ParticipantProxyData* record = nullptr;
    std::chrono::steady_clock::time_point last_message;  // as of the last look
    int silent_checks = 0;
    int unproven_checks = 0;    // in a secured session: without a proof of who it is
    bool has_returned = false;  // dropped before, and not yet known to speak
    bool is_trusted = false;    // in a secured session: has proven who it is
    bool is_secured = false;    // has announced that it proves who it is
  };

  struct Mismatch {
    std::string text;
    std::string topic;  ///< it matters to a participant of this topic alone; empty: to all
  };

  std::vector<Peer> all_peers() const;
  void check_other_hosts();
  void check_unproven();
  bool concerns(const Peer& peer) const;  ///< it is of the session, or all are read
  void count_elsewhere();
  void evaluate_discovered(const ParticipantPrefix& participant);
  bool has_other_clock(const ParticipantPrefix& participant) const;
  template <class Endpoint>
  void compare(const Endpoint& endpoint, bool writes, bool gone);
  void remember(const eprosima::fastrtps::rtps::WriterProxyData& writer, bool gone);

  ParticipantConfig config_;
  std::atomic<int>& peers_elsewhere_;
  std::function<void()> on_return_;
  ParticipantPorts ports_;
  const std::shared_ptr<TransportLink> link_ = std::make_shared<TransportLink>();
  fast::DomainParticipant* participant_ = nullptr;
  fast::Publisher* publisher_ = nullptr;
  fast::Subscriber* subscriber_ = nullptr;

  mutable std::mutex mutex_;
  std::map<ParticipantPrefix, Known> peers_;
  std::set<ParticipantPrefix> dropped_;  // at some time
  std::map<Guid, Mismatch> mismatches_;  // what is wrong with an endpoint or a participant
  std::set<std::string> own_topics_;     // of the table, that this participant reads or writes
  std::map<Guid, FoundWriter> writers_;  // of other participants
};

}  // namespace cordis::dds
