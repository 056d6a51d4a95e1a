// node/dds/presence.cpp
#include "node/dds/presence.h"

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <utility>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/rtps/attributes/ServerAttributes.h>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "node/dds/departure.h"
#include "node/dds/library_faults.h"
#include "node/dds/process_identity.h"
#include "node/dds/resending_thread.h"
#include "node/dds/socket_buffer.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

// Below what an Ethernet frame holds, in a tunnel too: a larger datagram is lost with any of its
// parts.
constexpr std::uint32_t kLargestDatagramBytes = 1400;
// In a secured session what authenticates a participant comes in one piece: its certificate and its
// permissions have 6 kB.
constexpr std::uint32_t kLargestSecuredBytes = 16384;
constexpr int kUnprovenChecks = 3;          // [s] others of the session prove who they are sooner
constexpr int kLateAnnouncementChecks = 5;  // [s] longer than any datagram is under way
constexpr const char* kDiscoveryGroup = "239.255.0.1";  // [DDSI 9.6.1.4]
constexpr const char* kServerPrefix =
    "44.53.00.5f.45.50.52.4f.53.49.4d.41";  // `fastdds discovery -i 0`

rtps::Locator_t locator_of(const std::string& address, std::uint16_t port) {
  rtps::Locator_t locator;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  return locator;
}

/// Sets where a participant announces itself, and where it receives the announcements of others.
void set_discovery(const ParticipantConfig& config, const ParticipantPorts& ports,
                   rtps::BuiltinAttributes& builtin) {
  const Network& network = config.network;
  builtin.metatrafficUnicastLocatorList.push_back(locator_of(network.address, ports.discovery()));
  if (!network.server.empty()) {
    builtin.discovery_config.discoveryProtocol = rtps::DiscoveryProtocol_t::CLIENT;
    rtps::RemoteServerAttributes server;
    server.ReadguidPrefix(kServerPrefix);
    server.metatrafficUnicastLocatorList.push_back(locator_of(network.server, network.server_port));
    builtin.discovery_config.m_DiscoveryServers.push_back(server);
    return;
  }
  const int here = pair_count(network.is_loopback());
  for (int index = 0; index < here; ++index)
    builtin.initialPeersList.push_back(
        locator_of(network.address, discovery_port(config.domain, index)));
  for (const std::string& peer : network.peers) {
    for (int index = 0; index < pair_count(false); ++index)
      builtin.initialPeersList.push_back(locator_of(peer, discovery_port(config.domain, index)));
  }
  if (!network.multicast) return;
  const rtps::Locator_t group = locator_of(kDiscoveryGroup, multicast_port(config.domain));
  builtin.metatrafficMulticastLocatorList.push_back(group);
  builtin.initialPeersList.push_back(group);
}

/// Names the plug-ins of DDS Security and their files.
void set_security(const Security& security, rtps::PropertyPolicy& policy) {
  const auto add = [&policy](const char* name, const std::string& value) {
    policy.properties().emplace_back(std::string("dds.sec.") + name, value);
  };
  const auto file = [](const std::string& path) { return "file://" + path; };
  add("auth.plugin", "builtin.PKI-DH");
  add("auth.builtin.PKI-DH.identity_ca", file(security.identity_authority));
  add("auth.builtin.PKI-DH.identity_certificate", file(security.certificate));
  add("auth.builtin.PKI-DH.private_key", file(security.private_key));
  add("access.plugin", "builtin.Access-Permissions");
  add("access.builtin.Access-Permissions.permissions_ca", file(security.permissions_authority));
  add("access.builtin.Access-Permissions.governance", file(security.governance));
  add("access.builtin.Access-Permissions.permissions", file(security.permissions));
  add("crypto.plugin", "builtin.AES-GCM-GMAC");
}

/// A secured participant has a GUID that depends on its certificate. Fast DDS takes two processes
/// whose GUIDs begin alike for one, where messages need no socket, and loses them.
void send_all_by_sockets() {
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

fast::DomainParticipantQos participant_qos(const ParticipantConfig& config,
                                           const ParticipantPorts& ports,
                                           const std::shared_ptr<TransportLink>& link) {
  using eprosima::fastrtps::Duration_t;
  fast::DomainParticipantQos qos;
  qos.name(config.session + "/" + config.node);
  const std::string identity =
      process_identity() + clock_mark(config.clock) + wire_version_mark(config.wire_version);
  qos.user_data().setValue({identity.begin(), identity.end()});

  // UDP on one address alone. On 127.0.0.1 it is as fast as shared memory, and no process blocks
  // when another is killed.
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back(config.network.address);
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  if (!config.network.is_loopback())
    udp->maxMessageSize = config.security.is_on() ? kLargestSecuredBytes : kLargestDatagramBytes;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(
      std::make_shared<UdpTransportDescriptor>(udp, config, ports.samples(), link));

  // On loopback no socket takes multicast, so no datagram of the network reaches a session. Others
  // are found where they can be.
  auto& builtin = qos.wire_protocol().builtin;
  set_discovery(config, ports, builtin);
  qos.wire_protocol().default_unicast_locator_list.push_back(
      locator_of(config.network.address, ports.samples()));

  // A participant that does not answer for a while may be a process that is stopped. When one of
  // two drops the other and not the other way round, they may stay deaf to each other for good, and
  // the timer of a lease that ends while its participant leaves aborts the process
  // (PDP::check_remote_participant_liveliness). So no lease ends, and no such timer fires;
  // processes that have ended are dropped by their identity.
  builtin.discovery_config.leaseDuration = eprosima::fastrtps::c_TimeInfinite;
  builtin.discovery_config.leaseDuration_announcementperiod = Duration_t(1, 0);
  if (config.security.is_on()) set_security(config.security, qos.properties());
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

/// The port of a participant that has the address of this host; 0 if it has another.
std::uint16_t discovery_port_of(const rtps::ParticipantProxyData& found,
                                const std::string& own_address) {
  for (const rtps::Locator_t& locator : found.metatraffic_locators.unicast) {
    if (rtps::IPLocator::toIPv4string(locator) == own_address)
      return static_cast<std::uint16_t>(locator.port);
  }
  return 0;
}

/// Two hosts may have processes of the same identity, as copies of one virtual machine do: only a
/// process that has the address of this host is looked up here.
bool has_ended(const Peer& peer, const std::string& own_address) noexcept {
  if (!peer.is_here()) return false;
  const ProcessState state = state_of(peer.process);
  // A program of others says nothing of its process, but its port is free when it has ended.
  const bool silent = state == ProcessState::kUnknown;
  return state == ProcessState::kEnded || (silent && is_free(peer.discovery_port, own_address));
}

std::string keyless_text(const std::string& peer) {
  return "'" + peer + "' is secured, and this process has no keys: it receives nothing of it; " +
         "name the keys with 'security' in the launch file, or with --security FOLDER";
}

/// @param is_secured  the peer has keys
std::string unproven_text(const std::string& peer, bool is_secured) {
  return "'" + peer + "' " +
         (is_secured
              ? "and this process do not trust each other yet: their keys are of two keyrings, "
                "or the machine is too busy; "
              : "has no keys, and this process has: they exchange nothing; ") +
         "give all parts of a session keys of one keyring";
}

}  // namespace

WriterId writer_id(const rtps::GUID_t& guid) {
  WriterId id;
  std::copy_n(guid.guidPrefix.value, 12, id.begin());
  std::copy_n(guid.entityId.value, 4, id.begin() + 12);
  return id;
}

Presence::Presence(const ParticipantConfig& config, std::atomic<int>& peers_elsewhere,
                   std::function<void()> on_return)
    : config_(config),
      peers_elsewhere_(peers_elsewhere),
      on_return_(std::move(on_return)),
      ports_(config.domain, config.network.address, config.observes) {
  fast::Log::SetVerbosity(fast::Log::Kind::Error);
  // A deadline that a device has missed when it went is no error.
  fast::Log::SetErrorStringFilter(std::regex("^(?!Could not set next deadline)"));
  take_out_library_faults();
  if (config.security.is_on()) send_all_by_sockets();
  const std::vector<pid_t> threads_before = threads_of_process();
  participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(config.domain), participant_qos(config, ports_, link_), this,
      fast::StatusMask::none());
  lower_resending_thread(threads_before);
  // Without its interface Fast DDS makes a participant that has no sockets.
  const bool is_bound =
      participant_ != nullptr && !is_free(ports_.discovery(), config.network.address);
  if (participant_ != nullptr && !is_bound)
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  if (!is_bound) {
    throw std::runtime_error("DDS could not join domain " + std::to_string(config.domain) + " on " +
                             config.network.address + " (is the interface up?)");
  }
  link_->is_open.store(true, std::memory_order_release);
  fast::PublisherQos publisher_qos;
  publisher_qos.partition().push_back(config.session.c_str());
  publisher_ = participant_->create_publisher(publisher_qos);
  fast::SubscriberQos subscriber_qos;
  if (config.every_partition) {
    // "*" fits every name of a partition, and not those who write outside of all.
    subscriber_qos.partition().push_back("");
    subscriber_qos.partition().push_back("*");
  } else {
    subscriber_qos.partition().push_back(config.session.c_str());
  }
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
  {
    const std::lock_guard lock(mutex_);
    own_topics_.insert(row.name);
  }
  return topic(std::string(row.name), std::move(type));
}

fast::Topic* Presence::topic(const std::string& name, fast::TypeSupport type) {
  if (auto* known = dynamic_cast<fast::Topic*>(participant_->lookup_topicdescription(name))) {
    if (known->get_type_name() == type.get_type_name()) return known;
    throw std::runtime_error("topic " + name + " has type " + known->get_type_name() +
                             " here and not " + type.get_type_name());
  }
  type.register_type(participant_);
  fast::Topic* created =
      participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  if (created == nullptr) throw std::runtime_error("DDS refused the topic " + name);
  return created;
}

std::vector<Peer> Presence::peers() const {
  const std::lock_guard lock(mutex_);
  std::vector<Peer> peers;
  for (const auto& [prefix, known] : peers_) {
    if (known.is_trusted) peers.push_back(known.peer);
  }
  return peers;
}

/// Also those that have not proven who they are.
std::vector<Peer> Presence::all_peers() const {
  const std::lock_guard lock(mutex_);
  std::vector<Peer> peers;
  for (const auto& [prefix, known] : peers_) peers.push_back(known.peer);
  return peers;
}

bool Presence::is_here(const ParticipantPrefix& participant) const {
  const std::lock_guard lock(mutex_);
  const auto found = peers_.find(participant);
  return found == peers_.end() || found->second.peer.is_here();
}

std::vector<FoundWriter> Presence::writers() const {
  const std::lock_guard lock(mutex_);
  std::vector<FoundWriter> writers;
  for (const auto& [guid, writer] : writers_) writers.push_back(writer);
  return writers;
}

std::optional<FoundWriter> Presence::writer(const WriterId& id) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(writers_, [&](const auto& writer) { return writer.second.id == id; });
  if (found == writers_.end()) return std::nullopt;
  return found->second;
}

std::string Presence::mismatch() const {
  const std::lock_guard lock(mutex_);
  for (const auto& [guid, mismatch] : mismatches_) {
    if (mismatch.topic.empty() || own_topics_.contains(mismatch.topic)) return mismatch.text;
  }
  return {};
}

void Presence::evaluate(const ParticipantPrefix& participant, std::uint32_t wire_version) {
  record_wire_version(participant, wire_version);
  if (wire_version == config_.wire_version) return;
  const std::lock_guard lock(mutex_);
  const auto peer = peers_.find(participant);
  const std::string name = peer == peers_.end() ? "another program" : peer->second.peer.name;
  mismatches_[guid_of(participant)] = {
      wire_version_refusal(name, wire_version, config_.wire_version), ""};
}

void Presence::drop_who_is_gone() noexcept {
  try {
    for (const Peer& peer : all_peers()) {
      if (has_ended(peer, config_.network.address)) drop(peer);
    }
    if (!config_.network.is_loopback()) check_other_hosts();
    if (config_.security.is_on()) check_unproven();
  } catch (...) {  // out of memory: the next time
  }
}

void Presence::drop(const Peer& peer) noexcept {
  // What cannot be sent is sent again: the peer is still there at the next look.
  static_cast<void>(send_departure(peer.prefix, ports_.discovery(), config_.network.address));
}

/// Counts how long each participant of another host has been silent, and drops it at last. One that
/// was dropped before and speaks again has returned: a single announcement that came late, behind
/// the farewell, is none.
void Presence::check_other_hosts() {
  std::vector<Peer> silent;
  bool returned = false;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [prefix, known] : peers_) {
      if (known.peer.is_here()) continue;
      const auto last = known.record->last_received_message_tm();
      const bool speaks = last != std::exchange(known.last_message, last);
      known.silent_checks = speaks ? 0 : known.silent_checks + 1;
      if (speaks && std::exchange(known.has_returned, false)) returned = true;
      const int limit = known.has_returned ? kLateAnnouncementChecks : kForgottenAfterChecks;
      if (known.silent_checks >= limit) silent.push_back(known.peer);
    }
  }
  for (const Peer& peer : silent) drop(peer);
  if (returned) on_return_();
}

/// Marks peers that have not proven who they are, if no process of the session has: they have other
/// keys, or none. Anybody can announce such a peer, so beside trusted ones it changes nothing.
void Presence::check_unproven() {
  const std::lock_guard lock(mutex_);
  const bool has_company = std::ranges::any_of(peers_, [this](const auto& entry) {
    return entry.second.is_trusted && concerns(entry.second.peer);
  });
  for (auto& [prefix, known] : peers_) {
    if (known.is_trusted || !concerns(known.peer)) continue;
    known.unproven_checks = has_company ? 0 : known.unproven_checks + 1;
    if (has_company) mismatches_.erase(guid_of(prefix));
    if (known.unproven_checks >= kUnprovenChecks)
      mismatches_[guid_of(prefix)] = {unproven_text(known.peer.name, known.is_secured), ""};
  }
}

/// The lock must be held.
void Presence::count_elsewhere() {
  peers_elsewhere_ = static_cast<int>(std::ranges::count_if(peers_, [this](const auto& entry) {
    const Peer& peer = entry.second.peer;
    return entry.second.is_trusted && !peer.is_here() &&
           peer.name.starts_with(config_.session + "/");
  }));
}

bool Presence::concerns(const Peer& peer) const {
  return config_.every_partition || peer.name.starts_with(config_.session + "/");
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
      count_elsewhere();
      dropped_.insert(prefix);
      mismatches_.erase(guid_of(prefix));
      std::erase_if(writers_,
                    [&](const auto& writer) { return prefix_of(writer.first) == prefix; });
      forget_wire_version(prefix);
      return;
    }
    const std::vector<rtps::octet> process = found.info.m_userData;
    Known& known = peers_[prefix];
    // Announcements come in the clear: none changes what is known of one that has proven who it is.
    if (!known.is_trusted || !config_.security.is_on()) {
      known.peer = {found.info.m_participantName.to_string(), prefix,
                    std::string(process.begin(), process.end()),
                    discovery_port_of(found.info, config_.network.address)};
    }
    known.is_trusted = known.is_trusted || !config_.security.is_on();
    known.is_secured = !found.info.identity_token_.is_nil();
    known.record = &found.info;  // it stays where it is until the participant is dropped
    count_elsewhere();
    // Others, of other programs, announce leases that end. What is handed over is the record of
    // Fast DDS itself: with this its timer does nothing, and so aborts nothing.
    const_cast<rtps::ParticipantProxyData&>(found.info).should_check_lease_duration = false;
    returned = found.status == Info::DISCOVERED_PARTICIPANT && dropped_.contains(prefix);
    if (returned && !known.peer.is_here()) {
      known.has_returned = true;
      known.last_message = found.info.last_received_message_tm();
      returned = false;
    }
  }
  evaluate_discovered(prefix);
  if (returned) on_return_();
}

/// Judges the version of a process of the session, before any message of it can come. In a secured
/// session its messages say it, which are encrypted: anybody can announce another version.
void Presence::evaluate_discovered(const ParticipantPrefix& participant) {
  if (config_.security.is_on()) return;
  std::optional<std::uint32_t> version;
  {
    const std::lock_guard lock(mutex_);
    const auto known = peers_.find(participant);
    if (known == peers_.end() || !known->second.is_trusted) return;
    const Peer& peer = known->second.peer;
    if (peer.name.starts_with(config_.session + "/")) version = marked_wire_version(peer.process);
    if (known->second.is_secured && concerns(peer))
      mismatches_[guid_of(participant)] = {keyless_text(peer.name), ""};
  }
  if (version) evaluate(participant, *version);
}

void Presence::onParticipantAuthentication(fast::DomainParticipant*,
                                           rtps::ParticipantAuthenticationInfo&& info) {
  using Info = rtps::ParticipantAuthenticationInfo;
  if (info.status != Info::AUTHORIZED_PARTICIPANT) return;
  const ParticipantPrefix prefix = prefix_of(info.guid);
  {
    const std::lock_guard lock(mutex_);
    const auto known = peers_.find(prefix);
    if (known == peers_.end()) return;
    known->second.is_trusted = true;
    mismatches_.erase(guid_of(prefix));
    count_elsewhere();
  }
  evaluate_discovered(prefix);
}

void Presence::on_publisher_discovery(fast::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) {
  remember(found.info, found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
  compare(found.info, true, found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

void Presence::on_subscriber_discovery(fast::DomainParticipant*,
                                       rtps::ReaderDiscoveryInfo&& found) {
  compare(found.info, false, found.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

/// Notes a writer of a partition from which this participant receives.
void Presence::remember(const rtps::WriterProxyData& writer, bool gone) {
  const std::lock_guard lock(mutex_);
  writers_.erase(writer.guid());
  std::vector<std::string> partitions = writer.m_qos.m_partition.names();
  const bool is_received =
      config_.every_partition || std::ranges::find(partitions, config_.session) != partitions.end();
  if (gone || !is_received) return;
  FoundWriter& found = writers_[writer.guid()];
  found.id = writer_id(writer.guid());
  found.topic = {
      .name = writer.topicName().to_string(),
      .type = writer.typeName().to_string(),
      .keyed = writer.topicKind() == rtps::WITH_KEY,
      .reliable = writer.m_qos.m_reliability.kind == fast::RELIABLE_RELIABILITY_QOS,
      .transient_local = writer.m_qos.m_durability.kind >= fast::TRANSIENT_LOCAL_DURABILITY_QOS,
      .exclusive = writer.m_qos.m_ownership.kind == fast::EXCLUSIVE_OWNERSHIP_QOS};
  const eprosima::fastrtps::Duration_t& deadline = writer.m_qos.m_deadline.period;
  if (found.topic.exclusive && deadline != eprosima::fastrtps::c_TimeInfinite)
    found.topic.deadline_nsec = deadline.to_ns();
  found.strength = writer.m_qos.m_ownershipStrength.value;
  found.partitions = std::move(partitions);
}

/// Precondition: the lock is held.
bool Presence::has_other_clock(const ParticipantPrefix& participant) const {
  const auto known = peers_.find(participant);
  if (known == peers_.end() || config_.clock.empty()) return false;
  const std::string_view clock = marked_clock(known->second.peer.process);
  return !clock.empty() && clock != config_.clock;
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
    } else if ((reliable != row.reliable && reliable != writes) ||
               has_other_clock(prefix_of(endpoint.guid()))) {
      what = "has another clock than that of this node";
    }
    if (what == nullptr) continue;
    mismatches_[endpoint.guid()] = {std::string("a process of session '") + config_.session +
                                        "' does not share " + row.name +
                                        " with this node: its launch file " + what +
                                        "; start all nodes of a session with the same launch file",
                                    row.name};
  }
}

}  // namespace cordis::dds
