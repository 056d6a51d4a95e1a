// node/dds/participant.cpp
#include "node/dds/participant.h"

#include <algorithm>
#include <regex>
#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include "node/dds/participant_impl.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::uint32_t kSocketBufferBytes = 4u << 20;

fast::DomainParticipantQos participant_qos(const Membership& membership) {
  using eprosima::fastrtps::Duration_t;
  fast::DomainParticipantQos qos;
  qos.name(membership.session + "/" + membership.node);

  // UDP on 127.0.0.1 alone: as fast as shared memory here, and no process blocks when another is
  // killed.
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->sendBufferSize = kSocketBufferBytes;
  udp->receiveBufferSize = kSocketBufferBytes;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);

  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  // Two processes that have lost and found each other again may stay deaf to one another for good
  // (seen in 4 of 120 cases), so one that stands still for a moment must not count as gone.
  discovery.leaseDuration = Duration_t(10, 0u);
  discovery.leaseDuration_announcementperiod = Duration_t(0, 300'000'000u);
  discovery.initial_announcements.count = 20;
  discovery.initial_announcements.period = Duration_t(0, 10'000'000u);
  return qos;
}

}  // namespace

Participant::Participant(const Membership& membership) : impl_(std::make_unique<Impl>()) {
  fast::Log::SetVerbosity(fast::Log::Kind::Error);
  // A deadline that a device has missed when it went is no error.
  fast::Log::SetErrorStringFilter(std::regex("^(?!Could not set next deadline)"));
  impl_->membership = membership;
  if (membership.domain < 0 || membership.domain > 101) {
    throw std::runtime_error("DDS domain must be 0..101, got " + std::to_string(membership.domain));
  }
  impl_->participant = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(membership.domain), participant_qos(membership), impl_.get(),
      fast::StatusMask::none());
  if (impl_->participant == nullptr) {
    throw std::runtime_error("DDS could not join domain " + std::to_string(membership.domain) +
                             " on 127.0.0.1 (is the loopback interface up?)");
  }

  fast::PublisherQos publisher_qos;
  publisher_qos.partition().push_back(membership.session.c_str());
  impl_->publisher = impl_->participant->create_publisher(publisher_qos);
  fast::SubscriberQos subscriber_qos;
  subscriber_qos.partition().push_back(membership.session.c_str());
  impl_->subscriber = impl_->participant->create_subscriber(subscriber_qos);
  if (impl_->publisher == nullptr || impl_->subscriber == nullptr) {
    throw std::runtime_error("DDS refused the session '" + membership.session + "'");
  }
}

Participant::~Participant() {
  impl_->participant->set_listener(nullptr);
  impl_->participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

const Membership& Participant::membership() const noexcept {
  return impl_->membership;
}

std::string Participant::mismatch() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->mismatches.empty() ? std::string() : impl_->mismatches.begin()->second;
}

void Participant::Impl::on_publisher_discovery(fast::DomainParticipant*,
                                               rtps::WriterDiscoveryInfo&& found) {
  compare(found.info, true, found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

void Participant::Impl::on_subscriber_discovery(fast::DomainParticipant*,
                                                rtps::ReaderDiscoveryInfo&& found) {
  compare(found.info, false, found.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

/// DDS would be silent about what does not fit.
template <class Endpoint>
void Participant::Impl::compare(const Endpoint& endpoint, bool writes, bool gone) {
  const std::lock_guard lock(mutex);
  mismatches.erase(endpoint.guid());
  const std::vector<std::string> partitions = endpoint.m_qos.m_partition.names();
  if (gone || std::ranges::find(partitions, membership.session) == partitions.end()) return;
  for (const Topic topic : kGestureTopics) {
    const TopicQos row = qos_of(topic, membership.lockstep, membership.stand_ins);
    if (endpoint.topicName() != row.name) continue;
    const bool exclusive = endpoint.m_qos.m_ownership.kind == fast::EXCLUSIVE_OWNERSHIP_QOS;
    const bool reliable = endpoint.m_qos.m_reliability.kind == fast::RELIABLE_RELIABILITY_QOS;
    const char* what = nullptr;
    if (exclusive != (row.exclusive_for_msec > 0)) {
      what = exclusive ? "names stand-ins ('plays'), and that of this node none"
                       : "names no stand-ins ('plays'), and that of this node does";
    } else if (reliable != row.reliable && reliable != writes) {
      what = "has another clock than that of this node";
    }
    if (what == nullptr) continue;
    mismatches[endpoint.guid()] = std::string("a process of session '") + membership.session +
                                  "' does not share " + row.name +
                                  " with this node: its launch file " + what +
                                  "; start all nodes of a session with the same launch file";
  }
}

fast::Topic* Participant::Impl::topic(const TopicQos& row, fast::TypeSupport type) {
  if (auto* known = dynamic_cast<fast::Topic*>(participant->lookup_topicdescription(row.name))) {
    return known;
  }
  type.register_type(participant);
  fast::Topic* made =
      participant->create_topic(row.name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  if (made == nullptr) throw std::runtime_error(std::string("DDS refused the topic ") + row.name);
  return made;
}

}  // namespace cordis::dds
