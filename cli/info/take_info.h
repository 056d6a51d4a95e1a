// cli/info/take_info.h -- what a take holds, for a person and for a program.
#pragma once

#include <cstdint>
#include <string>

#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// Messages that a recorder missed, as its take says; 0 where it says nothing.
struct MissedMessages {
  std::uint64_t dropped = 0;   ///< arrived, and found no room before the disk
  std::uint64_t lost = 0;      ///< never arrived
  std::uint64_t replaced = 0;  ///< part of `lost`: a writer that keeps its newest message alone
  std::uint64_t before = 0;    ///< written before the recorder had found their writers

  /// True if the recording lacks what it could have had: a frame that a newer one has replaced
  /// before it was sent is none of it.
  bool is_loss() const noexcept { return dropped + lost > replaced; }
};
MissedMessages missed_in(const mcap::Reader& take);

/// Lines for a person.
std::string take_text(const mcap::Reader& take);
/// JSON for a program; keys carry their unit.
std::string take_json(const mcap::Reader& take);

}  // namespace cordis::cli
