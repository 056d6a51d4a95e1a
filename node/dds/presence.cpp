// node/dds/presence.cpp
#include "node/dds/presence.h"

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <utility>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include "node/dds/departure.h"
#include "node/dds/process_identity.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::uint32_t kSocketBufferBytes = 4u << 20;

rtps::Locator_t loopback(std::uint16_t port) {
  rtps::Locator_t locator;
  rtps::IPLocator::setIPv4(locator, 127, 0, 0, 1);
  locator.port = port;
  return locator;
}

fast::DomainParticipantQos participant_qos(const ParticipantConfig& config,
                                           const ParticipantPorts& ports) {
  using eprosima::fastrtps::Duration_t;
  fast::DomainParticipantQos qos;
  qos.name(config.session + "/" + config.node);
  const std::string identity = process_identity() + wire_version_mark(config.wire_version);
  qos.user_data().setValue({identity.begin(), identity.end()});

  // UDP on 127.0.0.1 alone: as fast as shared memory here, and no process blocks when another is
  // killed.
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);

  // No socket takes multicast, so no datagram of the network reaches a session. Others are found
  // where they can be.
  auto& builtin = qos.wire_protocol().builtin;
  builtin.metatrafficUnicastLocatorList.push_back(loopback(ports.discovery()));
  qos.wire_protocol().default_unicast_locator_list.push_back(loopback(ports.samples()));
  for (int index = 0; index < kMaxParticipants; ++index) {
    builtin.initialPeersList.push_back(loopback(discovery_port(config.domain, index)));
  }

  // A participant that does not answer for a while may be a process that is stopped. When one of
  // two drops the other and not the other way round, they may stay deaf to each other for good, and
  // the timer of a lease that ends while its participant leaves aborts the process
  // (PDP::check_remote_participant_liveliness). So no lease ends, and no such timer fires;
  // processes that have ended are dropped by their identity.
  builtin.discovery_config.leaseDuration = eprosima::fastrtps::c_TimeInfinite;
  builtin.discovery_config.leaseDuration_announcementperiod = Duration_t(0, 300'000'000u);
  builtin.discovery_config.initial_announcements.count = 20;
  builtin.discovery_config.initial_announcements.period = Duration_t(0, 10'000'000u);
  return qos;
}

ParticipantPrefix prefix_of(const rtps::GUID_t& guid) {
  ParticipantPrefix prefix;
  std::copy_n(guid.guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

rtps::GUID_t guid_of(const ParticipantPrefix& prefix) {
  rtps::GUID_t guid;
  std::ranges::copy(prefix, guid.guidPrefix.value);
  guid.entityId = rtps::c_EntityId_RTPSParticipant;
  return guid;
}

std::uint16_t discovery_port_of(const rtps::ParticipantProxyData& found) {
  for (const rtps::Locator_t& locator : found.metatraffic_locators.unicast) {
    if (rtps::IPLocator::isLocal(locator)) return static_cast<std::uint16_t>(locator.port);
  }
  return 0;
}

bool has_ended(const Peer& peer) noexcept {
  const ProcessState state = state_of(peer.process);
  // A program of others says nothing of its process, but its port is free when it has ended.
  const bool silent = state == ProcessState::kUnknown && peer.discovery_port != 0;
  return state == ProcessState::kEnded || (silent && is_free(peer.discovery_port));
}

}  // namespace

Presence::Presence(const ParticipantConfig& config, std::function<void()> on_return)
    : config_(config), on_return_(std::move(on_return)), ports_(config.domain) {
  fast::Log::SetVerbosity(fast::Log::Kind::Error);
  // A deadline that a device has missed when it went is no error.
  fast::Log::SetErrorStringFilter(std::regex("^(?!Could not set next deadline)"));
  participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(config.domain), participant_qos(config, ports_), this,
      fast::StatusMask::none());
  if (participant_ == nullptr) {
    throw std::runtime_error("DDS could not join domain " + std::to_string(config.domain) +
                             " on 127.0.0.1 (is the loopback interface up?)");
  }
  fast::PublisherQos publisher_qos;
  publisher_qos.partition().push_back(config.session.c_str());
  publisher_ = participant_->create_publisher(publisher_qos);
  fast::SubscriberQos subscriber_qos;
  subscriber_qos.partition().push_back(config.session.c_str());
  subscriber_ = participant_->create_subscriber(subscriber_qos);
  if (publisher_ == nullptr || subscriber_ == nullptr) {
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    throw std::runtime_error("DDS refused the session '" + config.session + "'");
  }
}

Presence::~Presence() {
  participant_->set_listener(nullptr);
  participant_->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

fast::Topic* Presence::topic(const TopicQos& row, fast::TypeSupport type) {
  if (auto* known = dynamic_cast<fast::Topic*>(participant_->lookup_topicdescription(row.name))) {
    return known;
  }
  type.register_type(participant_);
  fast::Topic* made =
      participant_->create_topic(row.name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  if (made == nullptr) throw std::runtime_error(std::string("DDS refused the topic ") + row.name);
  return made;
}

std::vector<Peer> Presence::peers() const {
  const std::lock_guard lock(mutex_);
  std::vector<Peer> peers;
  for (const auto& [prefix, peer] : peers_) peers.push_back(peer);
  return peers;
}

std::string Presence::mismatch() const {
  const std::lock_guard lock(mutex_);
  return mismatches_.empty() ? std::string() : mismatches_.begin()->second;
}

void Presence::judge(const ParticipantPrefix& participant, std::uint32_t wire_version) {
  record_wire_version(participant, wire_version);
  if (wire_version == config_.wire_version) return;
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(participant);
  const std::string name = peer == peers_.end() ? "another program" : peer->second.name;
  mismatches_[guid_of(participant)] =
      wire_version_refusal(name, wire_version, config_.wire_version);
}

void Presence::drop_ended_processes() noexcept {
  try {
    for (const Peer& peer : peers()) {
      if (has_ended(peer)) drop(peer);
    }
  } catch (...) {  // out of memory: the next time
  }
}

void Presence::drop(const Peer& peer) noexcept {
  // What cannot be sent is sent again: the peer is still there at the next look.
  static_cast<void>(send_departure(peer.prefix, ports_.discovery()));
}

void Presence::on_participant_discovery(fast::DomainParticipant*,
                                        rtps::ParticipantDiscoveryInfo&& found) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const ParticipantPrefix prefix = prefix_of(found.info.m_guid);
  bool returned = false;
  {
    const std::lock_guard lock(mutex_);
    if (found.status == Info::REMOVED_PARTICIPANT || found.status == Info::DROPPED_PARTICIPANT) {
      peers_.erase(prefix);
      dropped_.insert(prefix);
      mismatches_.erase(guid_of(prefix));
      forget_wire_version(prefix);
      return;
    }
    const std::vector<rtps::octet> process = found.info.m_userData;
    peers_[prefix] = {found.info.m_participantName.to_string(), prefix,
                      std::string(process.begin(), process.end()), discovery_port_of(found.info)};
    // Others, of other programs, announce leases that end. What is handed over is the record of
    // Fast DDS itself: with this its timer does nothing, and so aborts nothing.
    const_cast<rtps::ParticipantProxyData&>(found.info).should_check_lease_duration = false;
    returned = found.status == Info::DISCOVERED_PARTICIPANT && dropped_.contains(prefix);
  }
  judge_discovered(prefix);
  if (returned) on_return_();
}

/// Judges the version of a process of the session, before any message of it can come.
void Presence::judge_discovered(const ParticipantPrefix& participant) {
  std::optional<std::uint32_t> version;
  {
    const std::lock_guard lock(mutex_);
    const Peer& peer = peers_[participant];
    if (peer.name.starts_with(config_.session + "/")) version = marked_wire_version(peer.process);
  }
  if (version) judge(participant, *version);
}

void Presence::on_publisher_discovery(fast::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) {
  compare(found.info, true, found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

void Presence::on_subscriber_discovery(fast::DomainParticipant*,
                                       rtps::ReaderDiscoveryInfo&& found) {
  compare(found.info, false, found.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

/// DDS would be silent about what does not fit.
template <class Endpoint>
void Presence::compare(const Endpoint& endpoint, bool writes, bool gone) {
  const std::lock_guard lock(mutex_);
  mismatches_.erase(endpoint.guid());
  const std::vector<std::string> partitions = endpoint.m_qos.m_partition.names();
  if (gone || std::ranges::find(partitions, config_.session) == partitions.end()) return;
  for (const Topic topic : kGestureTopics) {
    const TopicQos row = qos_of(topic, config_.lockstep, config_.standbys);
    if (endpoint.topicName() != row.name) continue;
    const bool exclusive = endpoint.m_qos.m_ownership.kind == fast::EXCLUSIVE_OWNERSHIP_QOS;
    const bool reliable = endpoint.m_qos.m_reliability.kind == fast::RELIABLE_RELIABILITY_QOS;
    const char* what = nullptr;
    if (exclusive != (row.exclusive_for_msec > 0)) {
      what = exclusive ? "names a hot standby ('standby_for'), and that of this node none"
                       : "names no hot standby ('standby_for'), and that of this node does";
    } else if (reliable != row.reliable && reliable != writes) {
      what = "has another clock than that of this node";
    }
    if (what == nullptr) continue;
    mismatches_[endpoint.guid()] = std::string("a process of session '") + config_.session +
                                   "' does not share " + row.name +
                                   " with this node: its launch file " + what +
                                   "; start all nodes of a session with the same launch file";
  }
}

}  // namespace cordis::dds
