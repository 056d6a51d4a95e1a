// cli/run/status_board.h -- the newest status of every node, and the table at the end of a run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "idl/control.h"

namespace cordis::cli {

/// Late ticks by cause.
struct LateTickSum {
  std::uint64_t by_machine = 0;
  std::uint64_t by_work = 0;
};

/// Keeps the newest status of each node by name.
class StatusBoard {
 public:
  /// @param first_epoch  statuses of an older life of a node, or of another process of the same
  /// name, are not of this session: an epoch is identified by its start on CLOCK_MONOTONIC [ns]
  explicit StatusBoard(std::uint64_t first_epoch) : first_epoch_(first_epoch) {}

  /// @return whether it was taken.
  bool put(const msg::NodeStatus& status);

  /// A node has been started again: what an older life of it said, or says as it arrives late, no
  /// longer counts, but for was_paused(). @param first_epoch  as above
  void begin_life(const std::string& node, std::uint64_t first_epoch);

  /// True if the newest status of a sim_node that played, in this or an earlier life, is `paused`;
  /// nothing without one.
  std::optional<bool> was_paused(const std::string& node) const;

  /// The session is being stopped: from now on no node answers for the silence of another, which
  /// is stopped before it.
  void begin_stop() { stopping_ = true; }

  /// Over all nodes.
  LateTickSum late_ticks() const;

  const msg::NodeStatus* find(
      const std::string& node) const;  ///< nullptr when this life of it never spoke

 private:
  void remember_pause(const msg::NodeStatus& status);

  std::uint64_t first_epoch_;
  bool stopping_ = false;
  std::map<std::string, std::uint64_t> first_epoch_of_;  // of those that were started again
  std::map<std::string, msg::NodeStatus> newest_;
  struct Pause {
    std::uint64_t epoch = 0;
    bool is_paused = false;
  };
  std::map<std::string, Pause> was_paused_;
};

/// A line per node in the order of `nodes`. It has the rate reached, overruns, latency, energy
/// drift, late ticks by their cause, and those without an answer of the other side. Lines of a
/// simulation follow: its running account, and its state as `state hash 0123456789abcdef after N
/// steps`; of one that did not say that it ended it is the `last known` state. Of a device there is what its hand was given, of a node that failed the reason. The text
/// ends with a newline.
std::string status_table(const std::vector<std::string>& nodes, const StatusBoard& board);

}  // namespace cordis::cli
