// node/dds/topics.cpp
#include "node/dds/topics.h"

namespace cordis::dds {

TopicQos qos_of(Topic topic, bool lockstep, bool standbys) noexcept {
  const int exclusive_for_msec = standbys ? 20 : 0;
  // name, reliable, kept, depth, asynchronous, heartbeat [ms], exclusive for [ms]
  switch (topic) {
    case Topic::kPositions:
      return lockstep
                 ? TopicQos{"gesture/positions", true, false, 8, false, 20}
                 : TopicQos{"gesture/positions", false, false, 1, false, 20, exclusive_for_msec};
    case Topic::kForces:
      return lockstep ? TopicQos{"gesture/forces", true, false, 8, false, 20}
                      : TopicQos{"gesture/forces", false, false, 1, false, 20, exclusive_for_msec};
    case Topic::kDevice:
      return {"device/description", true, true, 1, false, 50};
    case Topic::kDescription:
      return {"scene/description", true, true, 1, false, 50};
    case Topic::kFrame:
      return {"scene/frame", true, false, 1, true, 20};
    case Topic::kSignals:
      return {"scene/signals", true, false, 32, false, 50};
    case Topic::kEvents:
      return {"scene/events", true, false, 256, false, 50};
    case Topic::kCommand:
      return {"control/command", true, false, 32, false, 50};
    case Topic::kReply:
      return {"control/reply", true, false, 32, false, 50};
    case Topic::kStatus:
      return {"node/status", true, true, 1, false, 50};
  }
  return {};
}

}  // namespace cordis::dds
