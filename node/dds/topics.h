// node/dds/topics.h -- the one table of topics: name, message, quality of service.
#pragma once

#include <array>
#include <cstdint>

namespace cordis::dds {

/// The topics of the contract (idl/README.md).
enum class Topic : std::uint8_t {
  kPositions,      ///< gesture/positions   msg::GesturePositions
  kForces,         ///< gesture/forces      msg::GestureForces
  kDevice,         ///< device/description  msg::DeviceDescription
  kPointerTarget,  ///< pointer/target   msg::PointerTarget
  kPointerState,   ///< pointer/state    msg::PointerState
  kDescription,    ///< scene/description   msg::SceneDescription
  kFrame,          ///< scene/frame         msg::SceneFrame
  kSignals,        ///< scene/signals       msg::SceneSignals
  kSound,          ///< scene/sound         msg::SceneSound
  kEvents,         ///< scene/events        msg::SceneEvents
  kInputs,         ///< scene/inputs        msg::SceneInputs
  kCommand,        ///< control/command     msg::ControlCommand
  kReply,          ///< control/reply       msg::ControlReply
  kStatus          ///< node/status         msg::NodeStatus
};

/// Quality of service of a topic, in the words of DDS.
struct TopicQos {
  const char* name;
  bool reliable;
  bool transient_local;  ///< transient local, else volatile
  int history_depth;     ///< keep last
  bool asynchronous;     ///< written by a thread of the middleware: for large frames
  int heartbeat_msec;    ///< period of a reliable writer's heartbeats
  /// The strongest of several writers of a key is read, until it has been silent for so long;
  /// 0: all are read.
  int exclusive_for_msec = 0;
  /// Each sample has the memory of its message. Otherwise the largest of its type is reserved for
  /// each, and pages that it has used stay.
  bool sized_by_message = false;
};

/// What a reader asks of a reliable writer.
enum class Repair : std::uint8_t {
  kOfTopic,  ///< what the topic says: a reliable one is sent again where it was lost
  kNone      ///< nothing: what is lost stays lost, and no acknowledgement is sent or timed
};

/// @param lockstep   the two gesture topics are reliable in a lockstep session, and best effort
///                   otherwise
/// @param standbys  they are exclusive in a session where several nodes may play a device. The
///                   deadline that this needs costs 40 us of CPU a message on either side.
TopicQos qos_of(Topic topic, bool lockstep, bool standbys) noexcept;

/// The topics whose quality of service depends on the launch file.
inline constexpr std::array kGestureTopics{Topic::kPositions, Topic::kForces};

}  // namespace cordis::dds
