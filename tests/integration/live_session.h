// tests/integration/live_session.h -- real nodes in a DDS domain of this test's own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "node/dds/participant.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"

namespace cordis::test {

/// The executables that a session runs.
struct Build {
  std::string folder;              ///< empty: of this build
  std::uint32_t wire_version = 0;  ///< version that they speak; 0: that of this build
  bool is_secured = false;         ///< the session has keys of its own
};

/// A folder with a launch file and what belongs to it, the nodes of it that the test has started,
/// and a DDS participant of the test itself in the same session. Everything ends with the object.
/// When a test has failed, the output of every process is printed.
class LiveSession {
 public:
  /// @param clock  realtime, lockstep or asap
  /// @param nodes  YAML text of the mapping `nodes:`, indented by two
  explicit LiveSession(const std::string& clock, const std::string& nodes,
                       const std::string& session = "test", Build build = {});
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  void add_file(const std::string& name, const std::string& text) const;

  /// Starts `program LAUNCH --name name words...`.
  ChildProcess& start(const std::string& program, const std::string& name,
                      const std::vector<std::string>& words = {});
  /// Starts `cordis run LAUNCH words...`.
  ChildProcess& start_launcher(const std::vector<std::string>& words = {});

  ChildProcess& node(const std::string& name) { return *processes_.at(name); }
  std::string launch_file() const { return (folder_ / "launch.yaml").string(); }
  const std::filesystem::path& folder() const { return folder_; }
  dds::Participant& participant() { return *participant_; }

 private:
  Build build_;
  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
  std::vector<std::unique_ptr<ChildProcess>> ended_;  // replaced by a restart, kept for their
                                                      // output
  std::unique_ptr<dds::Participant> participant_;
};

/// Path of an executable of this build.
std::string program_path(const std::string& program);

}  // namespace cordis::test
