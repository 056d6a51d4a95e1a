// node/dds/participant_impl.h -- what Participant, Reader and Writer share of Fast DDS. Included by
// node/dds alone.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "node/dds/participant.h"
#include "node/dds/topics.h"

namespace cordis::dds {

namespace fast = eprosima::fastdds::dds;

struct Participant::Impl : fast::DomainParticipantListener {
  using Guid = eprosima::fastrtps::rtps::GUID_t;

  Membership membership;
  fast::DomainParticipant* participant = nullptr;
  fast::Publisher* publisher = nullptr;
  fast::Subscriber* subscriber = nullptr;

  /// The topic of the table, made at its first use. `type` is registered when its name is new.
  fast::Topic* topic(const TopicQos& row, fast::TypeSupport type);

  void on_publisher_discovery(fast::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override;
  void on_subscriber_discovery(fast::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& found) override;

  mutable std::mutex mutex;
  std::map<Guid, std::string> mismatches;  // what is wrong with an endpoint

 private:
  template <class Endpoint>
  void compare(const Endpoint& endpoint, bool writes, bool gone);
};

/// Reliability, durability, history, ownership and memory of a row, on a DataWriterQos or
/// DataReaderQos.
template <class Qos>
void apply(const TopicQos& row, Qos& qos) {
  qos.reliability().kind =
      row.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = row.kept_for_late_joiners ? fast::TRANSIENT_LOCAL_DURABILITY_QOS
                                                    : fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = row.history_depth;
  if (row.exclusive_for_msec > 0) {
    qos.ownership().kind = fast::EXCLUSIVE_OWNERSHIP_QOS;
    qos.deadline().period = eprosima::fastrtps::Duration_t(
        0, static_cast<std::uint32_t>(row.exclusive_for_msec) * 1'000'000u);
  }
  qos.data_sharing().off();
  qos.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  // A keyed topic holds one instance per device or node; the default limits would reserve 10 of 100
  // MB frames.
  qos.resource_limits().max_instances = 64;
  qos.resource_limits().max_samples_per_instance = row.history_depth;
  qos.resource_limits().max_samples = 64 * row.history_depth;
  qos.resource_limits().allocated_samples = row.history_depth;
}

}  // namespace cordis::dds
