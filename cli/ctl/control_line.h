// cli/ctl/control_line.h -- speaks to the nodes of a running session and receives their replies.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/session_address.h"
#include "idl/control.h"
#include "node/command_guard.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/roster.h"

namespace cordis::cli {

class ControlLine {
 public:
  /// @param key  of the session, when it has one that this process knows
  /// @throws std::runtime_error when DDS refuses.
  explicit ControlLine(const SessionAddress& address, std::optional<node::SessionKey> key = {});

  /// Sends a command until every addressed node that is there has answered, at most so long.
  /// @param target  a node, a kind of node, or "*"
  /// @return the replies, one per node
  std::vector<msg::ControlReply> ask(const std::string& target, msg::ControlVerb verb,
                                     const std::string& argument, std::chrono::nanoseconds at_most);

  /// The nodes that are alive: their last status is new, and not that they stop. Where a take
  /// is played, the player and not the nodes in the take.
  std::vector<std::string> present() const;
  /// Which process of the session this one cannot speak with, and why; empty when there is none.
  std::string mismatch() const { return participant_.mismatch(); }
  /// True if a command has been sent.
  bool has_sent() const noexcept { return sent_; }
  /// How many of them a target addresses.
  std::size_t addressed_count(const std::string& target) const;

 private:
  using Clock = std::chrono::steady_clock;

  /// The nodes that take commands.
  std::vector<msg::NodeStatus> listening() const;
  /// The nodes that a target addresses.
  std::vector<node::CommandedNode> addressed(const std::string& target) const;

  std::optional<node::SessionKey> key_;
  dds::Participant participant_;
  dds::Writer<msg::ControlCommand> commands_;
  dds::Reader<msg::ControlReply> replies_;
  node::Roster roster_;
  bool sent_ = false;
};

}  // namespace cordis::cli
