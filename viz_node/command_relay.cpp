// viz_node/command_relay.cpp
#include "viz_node/command_relay.h"

#include <utility>
#include <vector>

#include "node/command_guard.h"
#include "node/status_words.h"

namespace cordis::viz {

CommandRelay::CommandRelay(dds::Participant& participant, std::uint64_t epoch,
                           std::optional<node::SessionKey> key, PageRights rights, bool may_command)
    : session_(participant.config().session),
      sender_(participant.config().node + " " + std::to_string(epoch)),
      key_(std::move(key)),
      rights_(std::move(rights)) {
  if (may_command) writer_.emplace(participant, dds::Topic::kCommand);
}

void CommandRelay::take(const msg::NodeStatus& status) {
  if (!key_) return;
  if (status.kind() != msg::KIND_SIM_NODE && status.kind() != msg::KIND_PLAYER) return;
  const std::lock_guard lock(mutex_);
  if (node::has_ended(status.phase())) {
    targets_.erase(status.node());
  } else if (targets_.size() < kMaxTargets || targets_.contains(status.node())) {
    targets_[status.node()] = status.epoch();
  }
}

void CommandRelay::send(const PageCommand& wanted) noexcept {
  if (!writer_) return;
  try {
    msg::ControlCommand command;
    command.sender(sender_);
    command.target(node::word_of(msg::KIND_SIM_NODE));
    command.verb(wanted.verb);
    const std::optional<std::string> argument = argument_of(wanted, rights_);
    if (!argument) return;
    command.argument(*argument);
    const std::lock_guard lock(mutex_);
    command.command_id(++count_);
    std::vector<node::CommandedNode> targets;
    for (const auto& [name, epoch] : targets_) targets.push_back({name, epoch});
    if (key_) node::authenticate(command, *key_, session_, targets);
    static_cast<void>(writer_->write(command));  // the page sees no reply then
  } catch (...) {                                // no memory for it: the page sees no reply
  }
}

}  // namespace cordis::viz
