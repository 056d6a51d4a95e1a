// cli/run/other_nodes.h -- the nodes of a session that another launcher starts.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "idl/control.h"

namespace cordis::cli {

/// A node of the launch file that this launcher does not start.
struct OtherNode {
  std::string name;
  bool required = true;
};

/// Follows the statuses of nodes that run elsewhere, and states in sentences what a person must
/// know: which are missing, where each runs, and which has fallen silent.
class OtherNodes {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kMissedAfter{5};  ///< since the start
  static constexpr std::chrono::seconds kSilentAfter{5};  ///< ten statuses

  /// @param launch_words  the launch file and what changes it, as a shell takes them
  OtherNodes(const std::vector<OtherNode>& nodes, std::string launch_words, Time now);

  /// Takes a status. @return a sentence, or nothing; nothing too for a node that is not of these
  std::optional<std::string> take(const msg::NodeStatus& status, Time now);

  /// @return the sentences that the time has brought
  std::vector<std::string> update(Time now);

 private:
  struct Known {
    bool required = true;
    Time last;
    bool seen = false;      // ever
    bool is_there = false;  // speaks and has not ended
  };

  std::map<std::string, Known> nodes_;
  std::string launch_words_;
  Time begun_;
  bool has_reported_missing_ = false;
};

}  // namespace cordis::cli
