// sim_node/lockstep_loop.h -- the loop whose clock is its devices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "node/repeated_event.h"
#include "node/roster.h"
#include "sim_node/scene_loop.h"

namespace cordis::sim {

/// How long a lockstep session waits for a device that no node of its launch file plays.
struct Patience {
  std::string launch_file;
  std::vector<std::string> played;  ///< devices that its nodes play
  std::int64_t wait_nsec = 0;       ///< wall time; 0: without end
};

/// Plays one tick for each sample that every device of the scene has sent, and answers it.
class LockstepLoop {
 public:
  /// @param participant  on which nodes say that they are alive
  LockstepLoop(SceneLoop& loop, dds::Participant& participant, Patience patience);

  /// Until SceneLoop::finished(), or the patience is over.
  /// @return the sentence about the device that did not come; empty: none was waited for so long
  std::string run();

 private:
  bool receive();  // false when a sample is still missing
  void report_wait(const DeviceExchange& device);
  std::string sentence_of_absence(const DeviceExchange& device) const;

  SceneLoop& loop_;
  Patience patience_;
  node::Roster roster_;
  std::int64_t waits_since_nsec_ = 0;  // for a sample; 0: it does not
  bool is_wait_reported_ = false;
  std::string absence_;  // of the device that was waited for too long
  node::RepeatedEvent absences_{"has been waiting long, with no device_node alive"};
  node::RepeatedEvent silences_{
      "has been waiting long for a sample of a device_node that is alive"};
};

}  // namespace cordis::sim
