// viz_node/command_relay.h -- hands on what the pages want of the simulation.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "idl/control.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "node/session_key.h"
#include "viz_node/page_text.h"

namespace cordis::viz {

/// Writes control/command for the sim_node of the session. Any thread; does not wait.
class CommandRelay {
 public:
  /// @param key     of the session, when it has one
  /// @param rights  of pages; what goes beyond them is not sent
  /// @param may_command  false: nothing is ever sent
  /// @throws std::runtime_error when DDS refuses
  CommandRelay(dds::Participant& participant, std::uint64_t epoch,
               std::optional<node::SessionKey> key, PageRights rights, bool may_command);

  /// Takes the status of a node: commands go to the newest life of each sim_node and player.
  void take(const msg::NodeStatus& status);

  void send(const PageCommand& command) noexcept;

  /// True if a reply answers one of these commands.
  bool is_mine(const msg::ControlReply& reply) const { return reply.sender() == sender_; }

 private:
  static constexpr std::size_t kMaxTargets = 16;

  std::string session_;
  std::string sender_;
  std::optional<node::SessionKey> key_;
  PageRights rights_;
  std::mutex mutex_;
  std::map<std::string, std::uint64_t> targets_;  // epochs of those that commands are for, by name
  std::optional<dds::Writer<msg::ControlCommand>> writer_;
  std::uint64_t count_ = 0;
};

}  // namespace cordis::viz
