// viz_node/command_relay.h -- hands on what the pages want of the simulation.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "idl/control.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "viz_node/page_text.h"

namespace cordis::viz {

/// Writes control/command for the sim_node of the session. Any thread; does not wait.
class CommandRelay {
 public:
  /// @throws std::runtime_error when DDS refuses
  CommandRelay(dds::Participant& participant, std::uint64_t epoch);

  void send(const PageCommand& command) noexcept;

  /// True if a reply answers one of these commands.
  bool is_mine(const msg::ControlReply& reply) const { return reply.sender() == sender_; }

 private:
  std::string sender_;
  std::mutex mutex_;
  dds::Writer<msg::ControlCommand> writer_;
  std::uint64_t count_ = 0;
};

}  // namespace cordis::viz
