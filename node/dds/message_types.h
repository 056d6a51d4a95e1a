// node/dds/message_types.h -- which DDS type serves which message. Included by node/dds alone.
#pragma once

#include "idl/controlPubSubTypes.h"
#include "idl/gesturePubSubTypes.h"
#include "idl/inputsPubSubTypes.h"
#include "idl/scenePubSubTypes.h"

namespace cordis::dds {

/// A type whose samples are refused where they cannot be read. Fast DDS reads a sample of a topic with keys before
/// any reader does, in a thread of its own, where an exception ends the process.
template <class Generated>
class CarefulType final : public Generated {
 public:
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      return Generated::deserialize(payload, data);
    } catch (...) {
      return false;
    }
  }
};

template <class Message>
struct TypeOf;

template <>
struct TypeOf<msg::GesturePositions> {
  using Type = CarefulType<msg::GesturePositionsPubSubType>;
};
template <>
struct TypeOf<msg::GestureForces> {
  using Type = CarefulType<msg::GestureForcesPubSubType>;
};
template <>
struct TypeOf<msg::DeviceDescription> {
  using Type = CarefulType<msg::DeviceDescriptionPubSubType>;
};
template <>
struct TypeOf<msg::PointerTarget> {
  using Type = CarefulType<msg::PointerTargetPubSubType>;
};
template <>
struct TypeOf<msg::PointerState> {
  using Type = CarefulType<msg::PointerStatePubSubType>;
};
template <>
struct TypeOf<msg::SceneDescription> {
  using Type = CarefulType<msg::SceneDescriptionPubSubType>;
};
template <>
struct TypeOf<msg::SceneFrame> {
  using Type = CarefulType<msg::SceneFramePubSubType>;
};
template <>
struct TypeOf<msg::SceneSignals> {
  using Type = CarefulType<msg::SceneSignalsPubSubType>;
};
template <>
struct TypeOf<msg::SceneSound> {
  using Type = CarefulType<msg::SceneSoundPubSubType>;
};
template <>
struct TypeOf<msg::SceneEvents> {
  using Type = CarefulType<msg::SceneEventsPubSubType>;
};
template <>
struct TypeOf<msg::SceneInputs> {
  using Type = CarefulType<msg::SceneInputsPubSubType>;
};
template <>
struct TypeOf<msg::ControlCommand> {
  using Type = CarefulType<msg::ControlCommandPubSubType>;
};
template <>
struct TypeOf<msg::ControlReply> {
  using Type = CarefulType<msg::ControlReplyPubSubType>;
};
template <>
struct TypeOf<msg::NodeStatus> {
  using Type = CarefulType<msg::NodeStatusPubSubType>;
};

}  // namespace cordis::dds
