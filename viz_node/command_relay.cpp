// viz_node/command_relay.cpp
#include "viz_node/command_relay.h"

namespace cordis::viz {

CommandRelay::CommandRelay(dds::Participant& participant, std::uint64_t epoch)
    : sender_(participant.config().node + " " + std::to_string(epoch)),
      writer_(participant, dds::Topic::kCommand) {}

void CommandRelay::send(const PageCommand& wanted) noexcept {
  try {
    msg::ControlCommand command;
    command.sender(sender_);
    command.target("sim_node");
    command.verb(wanted.verb);
    if (wanted.verb == "step") command.argument(std::to_string(wanted.steps));
    const std::lock_guard lock(mutex_);
    command.command_id(++count_);
    writer_.write(command);
  } catch (...) {  // no memory for it: the page sees no reply
  }
}

}  // namespace cordis::viz
