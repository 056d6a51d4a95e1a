// node/command_server.h -- which commands are meant for a node, and that each is executed once.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "idl/control.h"

namespace cordis::node {

/// What a node says to a command: done, or why not.
struct Answer {
  bool accepted = false;
  std::string text;  ///< one clear sentence; behind it there may be lines with details
};

/// Obeys a command. Called from one thread; may take its time.
using Execute = std::function<Answer(const msg::ControlCommand&)>;

/// Picks the commands for one node, and answers each. A sender that receives no reply sends the
/// same command again: it is answered again, and not executed again.
class CommandServer {
 public:
  static constexpr std::size_t kRemembered = 64;

  CommandServer(std::string node, msg::NodeKind kind, Execute execute);

  /// The reply to a command; nothing when it is for others.
  [[nodiscard]] std::optional<msg::ControlReply> take(const msg::ControlCommand& command);

 private:
  std::string node_;
  msg::NodeKind kind_;
  Execute execute_;
  std::deque<msg::ControlReply> given_;  // the newest replies, oldest first
};

}  // namespace cordis::node
