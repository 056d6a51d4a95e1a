// node/dds/message_types.h -- which DDS type serves which message. Included by node/dds alone.
#pragma once

#include "idl/controlPubSubTypes.h"
#include "idl/gesturePubSubTypes.h"
#include "idl/inputsPubSubTypes.h"
#include "idl/scenePubSubTypes.h"

namespace cordis::dds {

template <class Message>
struct TypeOf;

template <>
struct TypeOf<msg::GesturePositions> {
  using Type = msg::GesturePositionsPubSubType;
};
template <>
struct TypeOf<msg::GestureForces> {
  using Type = msg::GestureForcesPubSubType;
};
template <>
struct TypeOf<msg::DeviceDescription> {
  using Type = msg::DeviceDescriptionPubSubType;
};
template <>
struct TypeOf<msg::PointerTarget> {
  using Type = msg::PointerTargetPubSubType;
};
template <>
struct TypeOf<msg::PointerState> {
  using Type = msg::PointerStatePubSubType;
};
template <>
struct TypeOf<msg::SceneDescription> {
  using Type = msg::SceneDescriptionPubSubType;
};
template <>
struct TypeOf<msg::SceneFrame> {
  using Type = msg::SceneFramePubSubType;
};
template <>
struct TypeOf<msg::SceneSignals> {
  using Type = msg::SceneSignalsPubSubType;
};
template <>
struct TypeOf<msg::SceneSound> {
  using Type = msg::SceneSoundPubSubType;
};
template <>
struct TypeOf<msg::SceneEvents> {
  using Type = msg::SceneEventsPubSubType;
};
template <>
struct TypeOf<msg::SceneInputs> {
  using Type = msg::SceneInputsPubSubType;
};
template <>
struct TypeOf<msg::ControlCommand> {
  using Type = msg::ControlCommandPubSubType;
};
template <>
struct TypeOf<msg::ControlReply> {
  using Type = msg::ControlReplyPubSubType;
};
template <>
struct TypeOf<msg::NodeStatus> {
  using Type = msg::NodeStatusPubSubType;
};

}  // namespace cordis::dds
