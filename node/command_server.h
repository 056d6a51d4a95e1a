// node/command_server.h -- which commands are meant for a node, and that each is executed once.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <string>

#include "idl/control.h"
#include "node/command_guard.h"

namespace cordis::node {

/// What a node says to a command: done, or why not.
struct Answer {
  bool accepted = false;
  std::string text;  ///< one clear sentence; behind it there may be lines with details
};

/// Executes a command. Called from one thread; may take its time.
using Execute = std::function<Answer(const msg::ControlCommand&)>;

/// What is left of a long command, for the thread of the commands.
using Finish = std::function<Answer()>;
/// The long part of a command, for a thread of its own; it changes nothing, and owns all that it
/// uses: the end of the node does not wait for it.
using Work = std::function<Finish()>;
/// The long part of a command; empty where it has none.
using FindWork = std::function<Work(const msg::ControlCommand&)>;

/// Picks the commands for one node, and answers each. A sender that receives no reply sends the
/// same command again: it is answered again, and not executed again. Other commands overtake one
/// with a long part, but for a second long one, which is refused. What the guard refuses is answered
/// and forgotten, so that a stranger takes no number away from a sender with the key.
class CommandServer {
 public:
  static constexpr std::size_t kRemembered = 64;

  CommandServer(std::string node, msg::NodeKind kind, Execute execute, FindWork find_work = {},
                CommandGuard guard = {});

  /// The reply to a command; nothing when it is for others, or when its long part has begun.
  [[nodiscard]] std::optional<msg::ControlReply> take(const msg::ControlCommand& command);

  /// True while the long part of a command is under way, or take_finished() is due.
  bool is_working() const noexcept { return work_.valid(); }
  /// The reply to a command with a long part, once that has ended.
  [[nodiscard]] std::optional<msg::ControlReply> take_finished();

 private:
  msg::ControlReply reply_to(const msg::ControlCommand& command, Answer answer) const;
  /// Executes a command, and remembers the reply.
  msg::ControlReply execute(const msg::ControlCommand& command,
                            const std::function<Answer()>& execute);

  std::string node_;
  msg::NodeKind kind_;
  Execute execute_;
  FindWork find_work_;
  CommandGuard guard_;
  std::deque<msg::ControlReply> replies_;  // the newest replies, oldest first
  msg::ControlCommand long_command_;
  std::future<Finish> work_;  // of long_command_
};

}  // namespace cordis::node
