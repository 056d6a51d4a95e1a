// record_node/mcap/chunk_contents.h -- the records of a chunk, unpacked and checked.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "record_node/mcap/compression.h"
#include "record_node/mcap/format.h"

namespace cordis::mcap {

/// Unpacks chunks; keeps its memory from one to the next.
class ChunkContents {
 public:
  /// Unpacks a chunk. @return what is wrong with it; empty when its CRC fits or it has none
  std::string unpack(const ChunkView& chunk);
  /// The records of the last chunk; valid until the next unpack().
  std::span<const std::byte> records() const noexcept { return records_; }

 private:
  Decompressor decompressor_;
  Bytes unpacked_;
  std::span<const std::byte> records_;
};

/// Calls `visit` with each record and its offset, until it says false.
/// @return false when the records end in the middle of one
bool for_each_record(std::span<const std::byte> records,
                     const std::function<bool(const Record&, std::uint64_t offset)>& visit);

}  // namespace cordis::mcap
