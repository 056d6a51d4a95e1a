// node/command_listener.h -- a node's ear for control/command, and its voice on control/reply.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "node/command_server.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"

namespace cordis::node {

/// Executes and answers the commands for a node, one after the other, in a thread of its own; the long
/// part of a command has another one. Create it before raising the priority of any thread.
class CommandListener {
 public:
  /// @param guard  which commands are executed
  CommandListener(dds::Participant& participant, msg::NodeKind kind, CommandGuard guard,
                  Execute execute, FindWork find_work = {});
  /// Waits until the command being executed, if any, is done.
  ~CommandListener();
  CommandListener(const CommandListener&) = delete;
  CommandListener& operator=(const CommandListener&) = delete;

  /// From now on commands are executed. Those that came before wait for it. Once.
  void start();

 private:
  void loop();

  dds::Reader<msg::ControlCommand> reader_;
  dds::Writer<msg::ControlReply> writer_;
  CommandServer server_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// For nodes that have nothing to execute: says so, as a refusal unless all nodes were addressed.
Answer nothing_to_do(const msg::ControlCommand& command, msg::NodeKind kind);

}  // namespace cordis::node
