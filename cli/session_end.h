// cli/session_end.h -- the end of a session that a verb reads, for verbs that would wait forever.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "cli/session_address.h"
#include "idl/control.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"

namespace cordis::cli {

/// Finds out when a session has ended. On this host its entry in the registry goes, whatever its nodes did
/// before: one that starts again ends nothing. A session that another user or host began ends with
/// silence: no node has spoken for kSilence. A session that has not begun yet has not ended, nor has a whole
/// domain.
class SessionEnd {
 public:
  static constexpr std::chrono::seconds kSilence{10};  ///< twenty statuses, and two restarts

  /// @throws std::runtime_error when DDS refuses
  explicit SessionEnd(SessionAddress address);

  /// Checks twice a second, however often it is called. @return the sentence that says so; empty before
  const std::string& update();

 private:
  using Time = std::chrono::steady_clock::time_point;

  bool is_registered() const;
  void take_statuses(Time now);

  const SessionAddress address_;
  std::unique_ptr<dds::Participant> participant_;  // where the registry does not know all nodes
  std::unique_ptr<dds::Reader<msg::NodeStatus>> statuses_;
  bool was_registered_ = false;
  int absences_ = 0;                    // polls since the registry had it
  std::optional<Time> last_;            // status of a node that goes on
  std::optional<Time> last_elsewhere_;  // likewise, on another host
  Time next_poll_;
  std::string sentence_;
};

}  // namespace cordis::cli
