// tests/campaigns/stall_watch.h -- how long force loops stalled, by the times in their samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "node/dds/participant.h"

namespace cordis::test {

/// Reads the positions of a device and the forces of a sim at 1 kHz, in a thread of its own. A sample that is lost
/// counts as written when it was due. A sim without a device writes none, so it has no stall then.
class StallWatch {
 public:
  /// @param sim     the name of the node that writes forces
  /// @param device  likewise positions
  StallWatch(dds::Participant& participant, std::string sim, std::string device);
  ~StallWatch();
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

  /// The longest time by which a sample of this node was late, since the call before. [s]
  double take_longest(const std::string& node);

 private:
  struct Loop {
    std::uint64_t epoch = 0;
    std::uint64_t number = 0;
    std::int64_t time_nsec = 0;
    double longest_s = 0.0;
  };

  void read() noexcept;
  void note(const std::string& node, std::uint64_t epoch, std::uint64_t number,
            std::int64_t time_nsec);

  dds::Participant& participant_;
  const std::string sim_;
  const std::string device_;
  std::mutex mutex_;
  std::map<std::string, Loop> loops_;
  std::atomic<bool> ending_{false};
  std::thread thread_;  // last: it uses the rest
};

}  // namespace cordis::test
