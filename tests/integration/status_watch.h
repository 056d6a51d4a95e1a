// tests/integration/status_watch.h -- the newest status of every node of a session.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "idl/control.h"
#include "node/dds/reader.h"

namespace cordis::test {

/// Listens to node/status.
class StatusWatch {
 public:
  explicit StatusWatch(dds::Participant& participant) : reader_(participant, dds::Topic::kStatus) {}

  /// Waits until the node's newest status fulfils `condition`; false when patience ends.
  bool wait_for(const std::string& node,
                const std::function<bool(const msg::NodeStatus&)>& condition);
  bool wait_for_phase(const std::string& node, msg::NodePhase phase);

  const msg::NodeStatus& of(const std::string& node) { return newest_[node]; }

 private:
  void take_all();
  void print(const std::string& node) const;

  dds::Reader<msg::NodeStatus> reader_;
  std::map<std::string, msg::NodeStatus> newest_;
};

}  // namespace cordis::test
