// node/dds/topics.cpp
#include "node/dds/topics.h"

#include "idl/topics.h"

namespace cordis::dds {
namespace {

/// QoS of the force loop: in lockstep every message counts, otherwise the newest alone.
TopicQos gesture_qos(const std::string& name, bool lockstep, bool standbys) noexcept {
  return {.name = name.c_str(),
          .reliable = lockstep,
          .transient_local = false,
          .history_depth = lockstep ? 8 : 1,
          .asynchronous = false,
          .heartbeat_msec = 20,
          .exclusive_for_msec = !lockstep && standbys ? 20 : 0};
}

/// The newest of each key, and what is lost is lost.
TopicQos newest_qos(const std::string& name) noexcept {
  return {.name = name.c_str(),
          .reliable = false,
          .transient_local = false,
          .history_depth = 1,
          .asynchronous = false,
          .heartbeat_msec = 20};
}

/// The newest of each key, also for who joins late. @param history_depth  so many
TopicQos transient_local_qos(const std::string& name, int history_depth = 1) noexcept {
  return {.name = name.c_str(),
          .reliable = true,
          .transient_local = true,
          .history_depth = history_depth,
          .asynchronous = false,
          .heartbeat_msec = 50};
}

/// A stream in which every message counts.
TopicQos stream_qos(const std::string& name, int history_depth) noexcept {
  return {.name = name.c_str(),
          .reliable = true,
          .transient_local = false,
          .history_depth = history_depth,
          .asynchronous = false,
          .heartbeat_msec = 50};
}

}  // namespace

TopicQos qos_of(Topic topic, bool lockstep, bool standbys) noexcept {
  switch (topic) {
    case Topic::kPositions:
      return gesture_qos(msg::TOPIC_POSITIONS, lockstep, standbys);
    case Topic::kForces:
      return gesture_qos(msg::TOPIC_FORCES, lockstep, standbys);
    case Topic::kDevice:
      // Each of several nodes that play one device describes it, once.
      return transient_local_qos(msg::TOPIC_DEVICE, 8);
    case Topic::kPointerTarget:
      return newest_qos(msg::TOPIC_POINTER_TARGET);
    case Topic::kPointerState:
      return newest_qos(msg::TOPIC_POINTER_STATE);
    case Topic::kDescription:
      return transient_local_qos(msg::TOPIC_DESCRIPTION);
    case Topic::kFrame:
      return {.name = msg::TOPIC_FRAME.c_str(),
              .reliable = true,
              .transient_local = false,
              .history_depth = 1,
              .asynchronous = true,
              .heartbeat_msec = 20};
    case Topic::kSignals:
      return stream_qos(msg::TOPIC_SIGNALS, 32);
    case Topic::kSound:  // half a second of blocks
      return stream_qos(msg::TOPIC_SOUND, 64);
    case Topic::kEvents:
      return stream_qos(msg::TOPIC_EVENTS, 256);
    case Topic::kInputs:  // who joins within the first seconds has them from the start
      return {.name = msg::TOPIC_INPUTS.c_str(),
              .reliable = true,
              .transient_local = true,
              .history_depth = 256,
              .asynchronous = true,
              .heartbeat_msec = 50,
              .sized_by_message = true};
    case Topic::kCommand:
      return stream_qos(msg::TOPIC_COMMAND, 32);
    case Topic::kReply:
      return stream_qos(msg::TOPIC_REPLY, 32);
    case Topic::kStatus:
      return transient_local_qos(msg::TOPIC_STATUS);
  }
  return {};
}

}  // namespace cordis::dds
