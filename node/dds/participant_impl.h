// node/dds/participant_impl.h -- what Participant, Reader and Writer share. Included by node/dds
// alone.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>

#include "node/dds/participant.h"
#include "node/dds/presence.h"
#include "node/dds/sample_socket.h"
#include "node/inherited_priority.h"

namespace cordis::dds {

/// A reader or a writer, which follows its participant from one presence to the next.
class Endpoint {
 public:
  /// Makes its entity of DDS again. @throws std::runtime_error when DDS refuses; all is as before
  virtual void prepare(Presence& presence) = 0;
  /// From now on the entity prepared is the one in use. That before is not used any more, and
  /// deleted with its presence.
  virtual void change_over() noexcept = 0;

 protected:
  ~Endpoint() = default;
};

struct Participant::Impl {
 public:
  /// @throws std::runtime_error when DDS refuses.
  explicit Impl(const ParticipantConfig& config);
  ~Impl();

  const ParticipantConfig& config() const noexcept { return config_; }
  std::vector<Peer> peers() const;
  std::vector<FoundWriter> writers() const;
  std::string mismatch() const;
  bool has_peers_elsewhere() const noexcept { return peers_elsewhere_ > 0; }
  std::uint64_t rejoin_count() const noexcept { return rejoin_count_; }
  /// Null unless it is for a loop.
  const std::shared_ptr<PresentSocket>& present_socket() const noexcept { return present_socket_; }
  void drop(const Peer& peer) const noexcept;

  /// Who makes or deletes parts of the participant has the priority of its threads meanwhile.
  /// `dds-resend` tries without a pause for what that caller has locked (resending_thread.h).
  node::InheritedPriority raised() const noexcept { return node::InheritedPriority(priority_); }

  /// How much of kFarewell is left. The first call begins it, and drops the readers of processes
  /// that have ended, which acknowledge nothing any more.
  std::chrono::milliseconds farewell() noexcept;

  /// @throws std::runtime_error when DDS refuses.
  void add(Endpoint& endpoint);
  /// @param delete_entity  called while no other presence can take its place
  template <class DeleteEntity>
  void remove(Endpoint& endpoint, DeleteEntity&& delete_entity) {
    const node::InheritedPriority priority = raised();
    const std::lock_guard lock(mutex_);
    std::erase(endpoints_, &endpoint);
    delete_entity();
  }

 private:
  std::unique_ptr<Presence> make_presence();
  void watch() noexcept;
  bool rejoin() noexcept;

  const int priority_ = node::realtime_priority();  // of its threads; 0: ordinary
  const ParticipantConfig config_;
  const std::shared_ptr<PresentSocket> present_socket_;

  std::mutex watch_mutex_;  // of the next two
  bool somebody_returned_ = false;
  bool ending_ = false;
  std::condition_variable woken_;

  std::atomic<int> peers_elsewhere_{0};
  mutable std::mutex mutex_;  // of the next two
  std::vector<Endpoint*> endpoints_;
  std::unique_ptr<Presence> presence_;
  std::atomic<std::uint64_t> rejoin_count_{0};
  std::mutex farewell_mutex_;  // of the next
  std::optional<std::chrono::steady_clock::time_point> farewell_end_;
  std::thread watch_;
};

/// Reliability, durability, history, ownership and memory of a row, on a DataWriterQos or
/// DataReaderQos.
template <class Qos>
void apply(const TopicQos& row, Qos& qos) {
  qos.reliability().kind =
      row.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      row.transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = row.history_depth;
  if (row.exclusive_for_msec > 0) {
    qos.ownership().kind = fast::EXCLUSIVE_OWNERSHIP_QOS;
    qos.deadline().period = eprosima::fastrtps::Duration_t(
        0, static_cast<std::uint32_t>(row.exclusive_for_msec) * 1'000'000u);
  }
  qos.data_sharing().off();
  qos.endpoint().history_memory_policy =
      row.sized_by_message ? eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE
                           : eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  // A keyed topic holds one instance per device or node; the default limits would reserve 10 of 100
  // MB frames.
  qos.resource_limits().max_instances = 64;
  qos.resource_limits().max_samples_per_instance = row.history_depth;
  qos.resource_limits().max_samples = 64 * row.history_depth;
  qos.resource_limits().allocated_samples = row.history_depth;
}

/// What a writer of a row is made with.
inline fast::DataWriterQos writer_qos_of(const TopicQos& row) {
  using eprosima::fastrtps::Duration_t;
  fast::DataWriterQos qos;
  apply(row, qos);
  qos.publish_mode().kind =
      row.asynchronous ? fast::ASYNCHRONOUS_PUBLISH_MODE : fast::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod =
      Duration_t(0, static_cast<std::uint32_t>(row.heartbeat_msec) * 1'000'000u);
  // A reader that does not take must never hold the writer: with keep-last the oldest sample is
  // overwritten.
  qos.reliability().max_blocking_time = Duration_t(0, 1'000'000u);
  return qos;
}

inline bool wait_for_acknowledgments(fast::DataWriter& writer, std::chrono::milliseconds at_most) {
  const auto msec = at_most.count();
  const eprosima::fastrtps::Duration_t limit(static_cast<std::int32_t>(msec / 1000),
                                             static_cast<std::uint32_t>(msec % 1000) * 1'000'000u);
  return writer.wait_for_acknowledgments(limit) == ReturnCode_t::RETCODE_OK;
}

}  // namespace cordis::dds
