// record_node/mcap/take_check.cpp
#include "record_node/mcap/take_check.h"

#include <algorithm>
#include <utility>

#include "record_node/mcap/crc32.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/mapped_file.h"
#include "record_node/mcap/scan.h"
#include "record_node/mcap/stored_summary.h"

namespace cordis::mcap {
namespace {

/// Says what the summary of a file claims and its data do not hold.
class SummaryCheck {
 public:
  SummaryCheck(const Summary& stored, const Scan& found, std::vector<Fault>& faults)
      : stored_(stored), found_(found), faults_(faults) {}

  void run() {
    check_counts();
    compare(stored_.schemas, found_.summary.schemas, "schemas");
    compare(stored_.channels, found_.summary.channels, "channels");
    compare(stored_.attachments, found_.summary.attachments, "attachments");
    compare(stored_.metadata, found_.summary.metadata, "metadata");
    for (const ChunkIndex& chunk : found_.summary.chunks) check_chunk(chunk);
  }

 private:
  void fault(std::uint64_t offset, std::string text) {
    faults_.push_back({offset, std::move(text)});
  }

  template <class List>
  void compare(const List& stored, const List& found, const std::string& what) {
    if (stored != found)
      fault(found_.data_end, "summary: its " + what + " are not those of the data");
  }

  void check_counts() {
    const Statistics& says = stored_.statistics;
    const Statistics& has = found_.summary.statistics;
    if (says.message_count != has.message_count)
      fault(found_.data_end, "summary: it counts " + std::to_string(says.message_count) +
                                 " messages, the data hold " + std::to_string(has.message_count));
    else if (says.channel_message_counts != has.channel_message_counts)
      fault(found_.data_end, "summary: its counts by channel are not those of the data");
    if (has.message_count != 0 &&
        (says.start_nsec != has.start_nsec || says.end_nsec != has.end_nsec))
      fault(found_.data_end, "summary: its first or last time is not that of the data");
  }

  void check_chunk(const ChunkIndex& chunk) {
    const auto same =
        std::find_if(stored_.chunks.begin(), stored_.chunks.end(),
                     [&chunk](const ChunkIndex& index) { return index.offset == chunk.offset; });
    if (same == stored_.chunks.end())
      fault(chunk.offset, "chunk: the summary does not know it");
    else if (same->length != chunk.length || same->start_nsec != chunk.start_nsec ||
             same->end_nsec != chunk.end_nsec || same->compression != chunk.compression ||
             same->uncompressed_size != chunk.uncompressed_size)
      fault(chunk.offset, "chunk: the summary says something else about it");
  }

  const Summary& stored_;
  const Scan& found_;
  std::vector<Fault>& faults_;
};

}  // namespace

std::vector<Fault> faults_of(std::span<const std::byte> file, const Scan& found) {
  std::vector<Fault> faults;
  for (const Damage& damage : found.damages) faults.push_back({damage.offset, damage.what});
  for (const std::size_t chunk : found.wrong_times)
    faults.push_back(
        {found.summary.chunks[chunk].offset, "chunk: its times are not those of its messages"});
  for (const MissingIndex& missing : found.missing)
    faults.push_back(
        {found.summary.chunks[missing.chunk].offset, "chunk: it has no index of its messages"});
  if (!found.has_data_end) {
    faults.push_back({found.data_end, "end of the file: its recorder did not close it"});
  } else {
    if (found.stored_data_crc != 0 && found.stored_data_crc != crc32(file.first(found.data_end)))
      faults.push_back({found.data_end, "end of the data: their CRC does not fit"});
    Summary stored;
    const std::string why = read_stored_summary(file, stored);
    const bool is_plain = why == kNoSummary || !found.loose.empty();
    if (why.empty()) {
      SummaryCheck(stored, found, faults).run();
    } else if (!is_plain) {
      faults.push_back({found.data_end, "end of the file: " + why});
    }
  }
  std::stable_sort(faults.begin(), faults.end(),
                   [](const Fault& a, const Fault& b) { return a.offset < b.offset; });
  return faults;
}

TakeCheck check_take(const std::filesystem::path& path) {
  const MappedFile file(path);
  if (!is_mcap(file.bytes())) throw FileError(path.string() + " is not an MCAP file");
  Scan found = scan(file.bytes());
  TakeCheck check;
  check.size = file.bytes().size();
  check.faults = faults_of(file.bytes(), found);
  check.statistics = std::move(found.summary.statistics);
  return check;
}

}  // namespace cordis::mcap
