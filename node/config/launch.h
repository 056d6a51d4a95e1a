// node/config/launch.h -- a launch file: which nodes make up a session.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "node/config/network.h"
#include "node/config/value.h"

namespace cordis::config {

/// The highest DDS domain whose ports stay below 32768 by the rules of RTPS.
inline constexpr int kHighestDomain = 101;

/// Who gives the time of a session.
enum class Clock {
  kRealtime,  ///< sim_node keeps absolute deadlines
  kLockstep,  ///< each device sample is one tick; the result does not depend on timing
  kAsap       ///< sim_node steps as fast as it can, without devices
};

/// The clock as a launch file spells it: "realtime", "lockstep" or "asap".
const char* clock_word(Clock clock) noexcept;

/// One node of a launch file: a process.
struct LaunchNode {
  std::string name;  ///< unique within the session; also the name of the device for a device_node
  std::string program;   ///< sim_node, device_node, viz_node or record_node
  bool required = true;  ///< the session ends when this node ends for good
  bool respawn = true;   ///< the launcher starts it again when it dies
  bool belongs = true;   ///< false: it is for sessions with another clock (`clock`)
  Value section;         ///< its mapping without launcher_keys(); the node reads it itself
  Place place;           ///< where the name stands
};

/// The keys of a node that the launcher reads: `node`, `required`, `respawn`, `clock`. All others belong to
/// the node itself.
const std::vector<std::string>& launcher_keys();

/// What a launch file says, with the overrides of the command line laid on it.
struct Launch {
  std::string file;
  std::filesystem::path directory;  ///< relative paths in the file start here
  std::string session;              ///< name of the session; DDS partition
  std::optional<int> domain;        ///< DDS domain, 0..101, where the file or a word names one
  std::optional<NetworkSection> network;  ///< absent: the session stays on this host
  std::string security;  ///< folder of keys, as the file names it; empty: nothing is encrypted
  Clock clock = Clock::kRealtime;
  std::vector<LaunchNode> nodes;  ///< in the order of the file

  /// True if a node plays the device of another (`standby_for` in its section).
  bool has_standbys() const noexcept;

  /// nullptr when there is none.
  const LaunchNode* find(const std::string& name) const noexcept;
  /// A path of the file as this process can open it.
  std::filesystem::path resolve(const std::string& path) const;
  /// Where the file lies, links and `..` resolved; empty when it is no longer there.
  std::filesystem::path real_folder() const;
  /// A path as it lies below real_folder(), links and `..` resolved; empty when it does not.
  std::filesystem::path find_below(const std::string& path) const;
};

/// Reads a launch file. Every fault is a problem: unknown keys and programs, a domain beyond
/// 0..101, no node, two sim_nodes, names with the same name_hash. So is a session name that is not
/// of 1 to 64 letters, digits, '_' and '-'. Without `session:` the session has the name of the
/// file. The sections of the nodes are not looked into. Without `required:` every node but a
/// viz_node and a record_node is required. Without `respawn:` every node starts again when it dies;
/// in a lockstep or asap session, whose result must not depend on a restart, those two alone. A
/// node with a `clock` other than that of the session is left out. `record:` stands for a
/// record_node named `record`.
/// @param overrides  words `name.key=value` (key of a node, may be nested: hand.mass_kg) and
///                   `clock=`, `domain=`, `session=`, `security=`, `record=`, `network.key=` for the
///                   session itself, each value in YAML; a word that fits nothing is a problem.
/// @return what could be read; to be used only when `problems` has no errors.
[[nodiscard]] Launch load_launch(const std::string& path, const std::vector<std::string>& overrides,
                                 Problems& problems);

/// Reads the text of a launch file in memory; `name` stands for its path.
[[nodiscard]] Launch load_launch_text(const std::string& text, const std::string& name,
                                      const std::vector<std::string>& overrides,
                                      Problems& problems);

/// A problem for a `network` without a `domain`. Who begins a session or checks a file asks; who
/// looks for a session that runs has its domain from the registry.
void check_domain(const Launch& launch, Problems& problems);

}  // namespace cordis::config
