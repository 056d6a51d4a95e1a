// viz_node/command_relay.cpp
#include "viz_node/command_relay.h"

#include <fmt/format.h>

#include "node/status_words.h"

namespace cordis::viz {

CommandRelay::CommandRelay(dds::Participant& participant, std::uint64_t epoch)
    : sender_(participant.config().node + " " + std::to_string(epoch)),
      writer_(participant, dds::Topic::kCommand) {}

void CommandRelay::send(const PageCommand& wanted) noexcept {
  try {
    msg::ControlCommand command;
    command.sender(sender_);
    command.target(node::word_of(msg::KIND_SIM_NODE));
    command.verb(wanted.verb);
    if (wanted.verb == msg::VERB_STEP) command.argument(std::to_string(wanted.steps));
    if (wanted.verb == msg::VERB_SEEK || wanted.verb == msg::VERB_RATE)
      command.argument(fmt::format("{:.6f}", wanted.value));
    const std::lock_guard lock(mutex_);
    command.command_id(++count_);
    static_cast<void>(writer_.write(command));  // the page sees no reply then
  } catch (...) {                               // no memory for it: the page sees no reply
  }
}

}  // namespace cordis::viz
