// device_node/dds_channel.h -- the force loop of a device over DDS.
#pragma once

#include <cstdint>
#include <memory>

#include "device_node/gesture_channel.h"
#include "node/dds/participant.h"

namespace cordis::device {

/// The two gesture topics, in the direction that the role of the device gives them.
/// @param strength   among the nodes that play the device
/// @param poll_nsec  for which it may poll for the answer to a sample, where that pays (AnswerPoll);
///                   0: it sleeps
/// @throws std::runtime_error when DDS refuses.
std::unique_ptr<GestureChannel> make_dds_channel(dds::Participant& participant, Role role,
                                                 std::uint32_t device_id, int strength,
                                                 std::int64_t poll_nsec);

}  // namespace cordis::device
