// record_node/mcap/take_check.h -- whether a take is what it says it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "record_node/mcap/records.h"
#include "record_node/mcap/scan.h"

namespace cordis::mcap {

/// One thing that is wrong.
struct Fault {
  std::uint64_t offset = 0;  ///< in the file [bytes]
  std::string text;
};

struct TakeCheck {
  Statistics statistics;  ///< counted, not read from the file
  std::uint64_t size = 0;
  std::vector<Fault> faults;  ///< in the order of the file
};

/// What is wrong with a file that was scanned, in its order.
std::vector<Fault> faults_of(std::span<const std::byte> file, const Scan& found);

/// Reads the whole file: every CRC, every message against its index, and the summary against the
/// records. @throws FileError when it cannot be read or is no MCAP file
TakeCheck check_take(const std::filesystem::path& path);

}  // namespace cordis::mcap
