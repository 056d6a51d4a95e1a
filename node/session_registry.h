// node/session_registry.h -- the sessions of a user on this host: their names, DDS domains and
// processes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/types.h>

#include "node/dds/network.h"

namespace cordis::node {

/// A process of a session, and the nodes that it runs or starts.
struct SessionMember {
  pid_t process = 0;
  std::string identity;  ///< dds::process_identity(): numbers of processes are used again
  std::vector<std::string> nodes;
  bool is_player = false;  ///< it plays a take
};

/// A session that runs, as its runtime file records it.
struct SessionRecord {
  std::string session;
  int domain = 0;
  std::string launch_file;             ///< absolute; of the process that began the session
  std::vector<SessionMember> members;  ///< alive
  dds::Network network{};              ///< network of all its processes on this host
  std::string keyring{};               ///< absolute folder of its keys; empty: it is not secured
};

/// The sessions that run, in the order of their names. Removes the files of sessions whose
/// processes are all dead.
/// @param folder  runtime_folder()
/// @throws std::runtime_error when the folder cannot be read or locked.
std::vector<SessionRecord> running_sessions(const std::filesystem::path& folder);

/// The domain that the next session without `domain` is given, as far as it can be known before.
/// @throws std::runtime_error as running_sessions(), or when no domain is free.
int domain_of_next_session(const std::filesystem::path& folder);

/// "domain 3", "domains 3 and 7"
std::string domains_text(const std::vector<SessionRecord>& sessions);

/// The entry that a process asks for.
struct SessionRequest {
  std::string session;
  std::optional<int> domain;  ///< absent: that of the running session of this name, else a free one
  std::string launch_file;
  std::vector<std::string> nodes;
  bool is_player = false;  ///< plays a take: refused with SessionRuns where the session runs
  bool simulates = false;  ///< has a sim_node or a device_node: refused where a take is played
  dds::Network network{};
  std::string keyring{};  ///< absolute folder of the keys that this process uses; empty: none
  /// Commands of the session need a key: that of chosen_key_file() or a new one, unless it has one.
  bool has_key = false;
};

/// True if a node of this program writes what a take has of a session: scene, hand or answers.
inline bool simulates(const std::string& program) {
  return program == "sim_node" || program == "device_node";
}

/// A session of that name runs already.
class SessionRuns : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// This process' entry in the registry, until the object or the process ends. No two sessions of
/// this host are given one domain, also of other users and beside other DDS programs.
class SessionRegistration {
 public:
  /// @throws std::runtime_error when a node of the same name runs in the session already, when the
  /// session speaks through another address of this host or is secured and the request is not, or
  /// the other way round, when sessions of this name run in several domains and the request names
  /// none, when no domain is free, when the folder cannot be used, or as `simulates` says.
  /// SessionRuns as `is_player` says.
  SessionRegistration(std::filesystem::path folder, const SessionRequest& request);
  ~SessionRegistration();
  SessionRegistration(const SessionRegistration&) = delete;
  SessionRegistration& operator=(const SessionRegistration&) = delete;

  int domain() const noexcept { return domain_; }

  /// This process no longer runs a node: another one may.
  void remove_node(const std::string& node) noexcept;

 private:
  void change_own_member(const std::function<void(SessionMember&)>& change) const noexcept;

  std::filesystem::path folder_;
  std::string session_;
  int domain_ = 0;
  int lock_ = -1;  // holds the domain
};

}  // namespace cordis::node
