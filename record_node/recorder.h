// record_node/recorder.h -- stores what is on the wire of a session, or of a whole domain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "node/dds/network.h"
#include "node/dds/security.h"
#include "record_node/mcap/compression.h"
#include "record_node/missed_messages.h"
#include "record_node/take_files.h"

namespace cordis::record {

/// What is recorded, and where to.
struct RecorderConfig {
  int domain = 0;
  std::string session;  ///< empty: the whole domain
  dds::Network network{};
  dds::Security security{};
  std::string node = "record";
  std::filesystem::path out;               ///< a file that is not there yet
  std::vector<std::string> topics;         ///< patterns; empty: all
  std::vector<std::string> excluded;       ///< patterns
  std::map<std::string, std::string> idl;  ///< texts of types beyond those of Cordis, by their file
  mcap::Compression compression = mcap::Compression::kZstd;
  std::size_t queue_bytes = std::size_t{12} << 20;
  std::map<std::string, std::string> about;  ///< facts of the session: `cordis.session` of the take
  std::vector<AttachedFile> attached;
  std::vector<std::string> plan_command;  ///< its output is attached as plan.txt; empty: none
};

/// What a recorder has done so far.
struct RecorderFigures {
  std::uint64_t messages = 0;  ///< received messages
  std::uint64_t bytes = 0;     ///< their size
  MissedMessages missed;
  std::uint64_t waiting_bytes = 0;
  std::uint64_t file_bytes = 0;
  std::uint64_t topics = 0;
  double seconds = 0.0;
  bool is_over = false;     ///< the file takes no more: `problem` says why
  bool has_failed = false;  ///< after close(): the file has no end, and is called `.part` still
  std::string problem;      ///< a sentence; empty when all is well
};

/// Records from its construction to close(). No process waits for it: its readers take at once, and a
/// queue of bounded size stands before the disk.
class Recorder {
 public:
  /// @throws mcap::FileError when the file cannot be made, std::runtime_error when DDS refuses,
  /// IdlError for a text of `idl` that is not understood
  explicit Recorder(RecorderConfig config);
  /// Closes.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  RecorderFigures figures() const;
  /// What of the session it cannot receive, and why: dds::Participant::mismatch().
  std::string mismatch() const;

  /// A sentence that names the patterns of `topics` that no topic has fitted so far, and the topics that
  /// there were; empty when each pattern has one.
  std::string unmatched() const;

  /// Writes what waits and ends the file. @return the last figures
  RecorderFigures close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cordis::record
