// record_node/mcap/chunk_contents.cpp
#include "record_node/mcap/chunk_contents.h"

#include "record_node/mcap/crc32.h"

namespace cordis::mcap {

std::string ChunkContents::unpack(const ChunkView& chunk) {
  records_ = {};
  if (chunk.compression.empty()) {
    if (chunk.records.size() != chunk.uncompressed_size) return "its size is not what it says";
    records_ = chunk.records;
  } else {
    std::string problem = decompressor_.decompress(chunk.compression, chunk.records,
                                                   chunk.uncompressed_size, unpacked_);
    if (!problem.empty()) return problem;
    records_ = unpacked_;
  }
  if (chunk.uncompressed_crc != 0 && crc32(records_) != chunk.uncompressed_crc)
    return "its CRC does not fit";
  return {};
}

bool for_each_record(std::span<const std::byte> records,
                     const std::function<bool(const Record&, std::uint64_t offset)>& visit) {
  std::uint64_t offset = 0;
  while (offset < records.size()) {
    const auto record = first_record(records.subspan(offset));
    if (!record) return false;
    if (!visit(*record, offset)) break;
    offset += record->size();
  }
  return true;
}

}  // namespace cordis::mcap
