// node/node_main.h -- what the main function of every node does before its own work begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "node/command_guard.h"
#include "node/config/launch.h"
#include "node/dds/network.h"
#include "node/dds/participant.h"
#include "node/security/identity.h"

namespace cordis::node {

inline constexpr int kBadInput = 2;  ///< a node ends with it: a file or the command line is wrong

/// A node as its command line and launch file describe it.
struct NodeStart {
  config::Launch launch;
  const config::LaunchNode* node = nullptr;  ///< its own entry in launch.nodes
  bool check_only = false;                   ///< --check: read and check everything, then end
  int domain = 0;                            ///< DDS domain of the session
  dds::Network network{};                    ///< what `network:` means on this host
  std::uint64_t epoch = 0;  ///< identifies this life of the process: its start time [ns]

  std::optional<SessionKey> key{};     ///< key of the session, when it has one
  std::optional<Identity> identity{};  ///< in a secured session

  /// False for a view that has a key to read alone.
  bool may_command() const noexcept {
    return !identity || identity->role == Role::kViewThatCommands;
  }

  dds::ParticipantConfig config() const;
  /// Lets pass what may command this node.
  CommandGuard command_guard() const;

  /// Joins the session once more, for the force loop alone. A participant has locks that all its
  /// writers and readers share. Here only the loop and the threads of DDS take them, so that the
  /// loop never waits for a thread of normal priority. In the realtime clock those threads have
  /// realtime priority, below that of the loops: without it forces come late on a busy machine.
  /// @throws std::runtime_error as Participant
  dds::Participant join_for_force_loop() const;
};

/// Reads `LAUNCH.yaml --name NAME [--check] [name.key=value ...]`, installs log and stop signals,
/// and joins the running session of that name or locks a domain for it (SessionRegistration). Then
/// it calls `run`, and turns whatever that throws into one clear message. The exit code is 2 for a
/// bad file or usage, 1 for a failure at run time.
/// @param kind  name of the program
/// @param run   does the node's work and returns its exit code; ConfigError and std::exception may
/// leave it
int node_main(int argc, char** argv, const std::string& kind,
              int (*run)(const NodeStart&, config::Problems&));

/// Ends the reading of files: logs the warnings.
/// @throws ConfigError when there is an error among the problems
void report(const config::Problems& problems);

}  // namespace cordis::node
