// record_node/mcap/recover.h -- makes a whole take of one that a crash or a bad disk has torn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "record_node/mcap/records.h"
#include "record_node/mcap/scan.h"

namespace cordis::mcap {

/// What a recovery found and did.
struct Recovery {
  bool was_whole = false;           ///< then the file is as it was
  bool was_closed = false;          ///< false: its recorder died
  std::filesystem::path path;       ///< path of the whole take: without `.part`
  Statistics statistics;            ///< figures of what is kept
  std::uint64_t cut_bytes = 0;      ///< length of the torn end
  std::uint64_t rebuilt_count = 0;  ///< chunks that had no index of their messages
  std::vector<Damage> damages;

  /// True if messages or attachments that were in the file are gone.
  bool has_loss() const noexcept;
};

/// Repairs a file in place. The torn end is cut; damaged records in the middle become records that
/// readers skip; missing indexes, the summary and the footer are written again. Every whole chunk
/// stays where it is. Cost: the whole file is read once or twice, and unpacked once.
/// @throws FileError when it is no MCAP file, is being recorded, or cannot be changed
Recovery recover(const std::filesystem::path& path);

}  // namespace cordis::mcap
