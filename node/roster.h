// node/roster.h -- which nodes of a session are alive, by what they say.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "idl/control.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"

namespace cordis::node {

/// Listens to node/status. A node is alive that has said something lately and has not said that it
/// ends: that DDS knows a process says nothing, for it may be stopped.
class Roster {
 public:
  /// @param lately  so long ago at most; nodes speak twice a second
  explicit Roster(dds::Participant& participant,
                  std::chrono::milliseconds lately = std::chrono::milliseconds(1500))
      : reader_(participant, dds::Topic::kStatus), lately_(lately) {}

  /// Takes what has been said since. Whoever asks below calls this several times a second from
  /// `lately` before, for a status counts from when it is taken.
  void update();

  /// The newest status of each node that is alive, by name.
  std::vector<msg::NodeStatus> alive() const;

  /// The name of a node of a kind that is alive, in quotes; empty when there is none.
  std::string name_of(msg::NodeKind kind) const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Known {
    msg::NodeStatus status;
    Clock::time_point taken;
  };

  dds::Reader<msg::NodeStatus> reader_;
  std::chrono::milliseconds lately_;
  msg::NodeStatus taken_;
  std::map<std::string, Known> nodes_;  // by name
};

}  // namespace cordis::node
