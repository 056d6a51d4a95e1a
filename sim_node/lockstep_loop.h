// sim_node/lockstep_loop.h -- the loop whose clock is its devices.
#pragma once

#include <cstdint>

#include "node/repeated_event.h"
#include "node/roster.h"
#include "sim_node/scene_loop.h"

namespace cordis::sim {

/// Plays one tick for each sample that every device of the scene has sent, and answers it.
class LockstepLoop {
 public:
  /// @param participant  on which nodes say that they are alive
  LockstepLoop(SceneLoop& loop, dds::Participant& participant);

  /// Until SceneLoop::finished().
  void run();

 private:
  bool receive();  // false when a sample is still missing
  void report_wait(const DeviceExchange& device);

  SceneLoop& loop_;
  node::Roster roster_;
  std::int64_t waits_since_nsec_ = 0;  // for a sample; 0: it does not
  node::RepeatedEvent absences_{"has been waiting long, with no device_node alive"};
  node::RepeatedEvent silences_{
      "has been waiting long for a sample of a device_node that is alive"};
};

}  // namespace cordis::sim
