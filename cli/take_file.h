// cli/take_file.h -- takes as a person names them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"

namespace cordis::cli {

/// Opens a take; of a torn one it says on stderr how much is left. @throws UsageError when there is none
std::unique_ptr<mcap::Reader> open_take(const std::string& verb, const std::string& file);

/// @param offset  the word of --start-offset
/// @return it behind the first message [ns]
/// @throws UsageError when it is beyond the last one
std::uint64_t start_offset_in(const mcap::Reader& take, const std::string& offset);

/// A new take for what a verb makes. @param compression  none, lz4 or zstd
/// @throws UsageError when it exists, or cannot be made
std::unique_ptr<mcap::Writer> make_take(const std::string& file, const std::string& compression);

/// Closes a take that a verb made, prints what it holds, and on stderr what of its sources could not
/// be read. @throws mcap::FileError when it is not whole
void finish_take(const std::string& verb, mcap::Writer& writer,
                 const std::vector<std::string>& problems);

/// "512 bytes", "34.1 kB", "1.2 MB", "3.4 GB"
std::string size_text(std::uint64_t bytes);

}  // namespace cordis::cli
