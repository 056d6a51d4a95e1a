// record_node/mcap/recover.cpp
#include "record_node/mcap/recover.h"

#include <algorithm>
#include <string>
#include <utility>

#include "record_node/mcap/chunk_builder.h"
#include "record_node/mcap/crc32.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/mapped_file.h"
#include "record_node/mcap/output_file.h"
#include "record_node/mcap/take_check.h"

namespace cordis::mcap {
namespace {

constexpr const char* kPart = ".part";

/// What stands in the place of damaged bytes: one record of the same length.
Bytes patch_of(const Damage& damage) {
  Bytes patch;
  if (damage.offset < kMagic.size()) {
    append_magic(patch);
    return patch;
  }
  constexpr std::uint64_t kHeaderSize = kRecordHead + 4 + 4;
  if (damage.offset == kMagic.size() && damage.length >= kHeaderSize) {
    append_header(patch, std::string(damage.length - kHeaderSize, ' '));
    return patch;
  }
  ByteWriter writer(patch);
  writer.number(static_cast<std::uint8_t>(Opcode::kDamaged));
  writer.number(damage.length - kRecordHead);
  return patch;
}

/// Writes the times of a chunk where its record has them.
WriteStatus write_times(OutputFile& out, const ChunkIndex& chunk) {
  Bytes times;
  ByteWriter writer(times);
  writer.number(chunk.start_nsec);
  writer.number(chunk.end_nsec);
  return out.overwrite(chunk.offset + kRecordHead, times);
}

void require(WriteStatus status, const OutputFile& file, const std::filesystem::path& path) {
  if (status != WriteStatus::kOk)
    throw FileError(path.string() + " cannot be repaired: " + file.problem());
}

/// The path without `.part`, unless that is taken.
std::filesystem::path final_name(const std::filesystem::path& path) {
  if (path.extension() != kPart) return path;
  const std::filesystem::path name = std::filesystem::path(path).replace_extension();
  return std::filesystem::exists(name) ? path : name;
}

}  // namespace

bool Recovery::has_loss() const noexcept {
  return std::any_of(damages.begin(), damages.end(),
                     [](const Damage& damage) { return damage.is_loss; });
}

Recovery recover(const std::filesystem::path& path) {
  OutputFile out;
  out.open(path);
  const MappedFile file(path);
  if (!is_mcap(file.bytes())) throw FileError(path.string() + " is not an MCAP file");
  Scan found = scan(file.bytes());
  Recovery recovery;
  recovery.path = final_name(path);
  recovery.was_closed = found.has_data_end;
  recovery.was_whole = faults_of(file.bytes(), found).empty();
  recovery.rebuilt_count = found.missing.size();
  recovery.cut_bytes = found.has_data_end ? 0 : file.bytes().size() - found.data_end;
  if (!recovery.was_whole) {
    for (const Damage& damage : found.damages) {
      if (damage.offset < found.data_end)
        require(out.overwrite(damage.offset, patch_of(damage)), out, path);
    }
    for (const std::size_t chunk : found.wrong_times)
      require(write_times(out, found.summary.chunks[chunk]), out, path);
    require(out.go_on_at(found.data_end, crc32(file.bytes().first(found.data_end))), out, path);
    Bytes end;
    for (const MissingIndex& missing : found.missing)
      append_message_indexes(end, out.position(), missing.entries,
                             found.summary.chunks[missing.chunk]);
    const std::uint32_t crc = crc32(end, out.crc());
    append_end(end, found.summary, out.position() + end.size(), crc);
    require(out.append(end), out, path);
  }
  require(out.close(), out, path);
  if (recovery.path != path) std::filesystem::rename(path, recovery.path);
  recovery.damages = std::move(found.damages);
  recovery.statistics = std::move(found.summary.statistics);
  return recovery;
}

}  // namespace cordis::mcap
