// record_node/record_config.h -- the section of a record_node in a launch file.
#pragma once

#include "node/config/launch.h"
#include "node/config/problem.h"
#include "record_node/recorder.h"

namespace cordis::record {

/// The name of a take that is not named.
inline constexpr const char* kUsualTake = "takes/{session}-{time}.mcap";

struct RecordSection {
  std::string out = kUsualTake;
  std::vector<std::string> topics;
  std::vector<std::string> excluded;
  std::vector<std::string> idl_files;
  mcap::Compression compression = mcap::Compression::kZstd;
};

/// Reads the keys out, topics, exclude, idl and compression, all optional. What is wrong goes to
/// `problems`.
RecordSection read_record_section(const config::LaunchNode& node, config::Problems& problems);

/// The texts of IDL files, by their path.
/// @throws std::runtime_error for one that cannot be read, IdlError for one that is not understood
std::map<std::string, std::string> read_idl_files(const std::vector<std::string>& files,
                                                  const std::filesystem::path& base);

/// The words `name.key=value` of the command line of this process, which is that of a node.
std::vector<std::string> own_overrides();

/// What a take says of its session: host, versions, clock, launch file and command line. It also
/// says how the clock of the messages (CLOCK_MONOTONIC) stands to that of the file (UTC), and each
/// seed that a file names, as `seed FILE: KEY`; `seed` is that of all others.
/// @param files  files_of() the launch
std::map<std::string, std::string> about_session(const config::Launch& launch,
                                                 const std::vector<AttachedFile>& files);

}  // namespace cordis::record
