// record_node/mcap/scan.h -- reads a file from its beginning and finds all that is whole in it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "record_node/mcap/format.h"
#include "record_node/mcap/summary.h"

namespace cordis::mcap {

/// A record that cannot be read, or is not what it says.
struct Damage {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string what;
  /// True if something was lost with them; a message index is found again in its chunk.
  bool is_loss = true;
};

/// The true index of a chunk whose own is absent or wrong.
struct MissingIndex {
  std::size_t chunk = 0;  ///< in the summary
  std::map<std::uint16_t, MessageIndex> entries;
};

/// What a file holds, found by reading all of it.
struct Scan {
  Summary summary;                    ///< as it would have to be
  std::vector<MissingIndex> missing;  ///< chunks whose own index is absent or wrong
  std::vector<MessageEntry> loose;    ///< messages outside chunks: offsets in the file
  std::vector<Damage> damages;        ///< in the order of the file
  /// Chunks that say other times than those of their messages.
  std::vector<std::size_t> wrong_times;
  std::uint64_t data_end = 0;         ///< after the last whole record of the data
  std::uint32_t stored_data_crc = 0;  ///< 0: none
  bool has_data_end = false;          ///< false: the file was never closed

  bool has_loss() const noexcept;
};

/// True if the bytes begin as a file of MCAP does; one wrong byte is accepted.
bool is_mcap(std::span<const std::byte> bytes) noexcept;

/// Reads every record and unpacks every chunk. Chunks whose CRC does not fit are damages. A channel
/// or schema whose record is damaged is taken from the summary of the file, where that is sound; so is
/// the place of a chunk. Where no summary says it either, messages in chunks keep a channel with the
/// topic lost_channel_ and its number.
/// Precondition: is_mcap().
Scan scan(std::span<const std::byte> bytes);

}  // namespace cordis::mcap
