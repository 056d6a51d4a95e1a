// node/command_guard.h -- which commands a node of a session with a key executes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "idl/control.h"
#include "node/session_key.h"

namespace cordis::node {

/// A process that takes part in a session, as its commands are addressed.
struct CommandedNode {
  std::string name;
  std::uint64_t epoch = 0;
};

/// Adds what shows each of these nodes that the sender has the key, in place of what was there.
/// Later changes of the command are refused.
void authenticate(msg::ControlCommand& command, const SessionKey& key, const std::string& session,
                  const std::vector<CommandedNode>& nodes);

/// The side of the node. Without a key it lets all pass.
class CommandGuard {
 public:
  enum class Verdict {
    kPasses,
    kIsForOthers,  ///< the sender did not mean this life of this node: it is not answered
    kRefused
  };

  /// A guard without a key.
  CommandGuard() = default;
  CommandGuard(std::optional<SessionKey> key, std::string session, CommandedNode node);

  /// Call it once for each command that is about to be executed: one that passes does so once.
  /// `get`, which changes nothing, always does.
  [[nodiscard]] Verdict evaluate(const msg::ControlCommand& command);
  /// Why the last command was refused, for a person.
  const std::string& reason() const noexcept { return reason_; }

 private:
  Verdict refuse(const char* reason);

  std::optional<SessionKey> key_;
  std::string session_;
  CommandedNode node_;
  std::uint32_t node_id_ = 0;
  // The newest command of each sender with the key. Each run of `cordis ctl` is a sender, of some
  // 100 bytes here.
  std::map<std::string, std::uint64_t> newest_;
  std::string reason_;
};

}  // namespace cordis::node
