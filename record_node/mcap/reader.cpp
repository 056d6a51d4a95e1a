// record_node/mcap/reader.cpp
#include "record_node/mcap/reader.h"

#include <utility>

#include "record_node/mcap/byte_reader.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/scan.h"
#include "record_node/mcap/stored_summary.h"
#include "record_node/mcap/topic_glob.h"

namespace cordis::mcap {

Reader::Reader(const std::filesystem::path& path) : path_(path), file_(path) {
  const std::span<const std::byte> bytes = file_.bytes();
  if (!is_mcap(bytes)) throw FileError(path.string() + " is not an MCAP file");
  read_library();
  const std::string why = read_stored_summary(bytes, summary_);
  if (!why.empty()) {
    scan_file(why);
  } else if (!read_attachments() || !read_metadata()) {
    scan_file("its summary is damaged");
  }
}

void Reader::read_library() {
  const auto record = first_record(file_.bytes().subspan(kMagic.size()));
  if (!record || record->opcode != Opcode::kHeader) return;
  ByteReader header(record->content);
  static_cast<void>(header.text());
  library_ = header.text();
}

void Reader::scan_file(const std::string& why) {
  Scan found = scan(file_.bytes());
  summary_ = std::move(found.summary);
  loose_ = std::move(found.loose);
  attachments_.clear();
  metadata_.clear();
  read_attachments();
  read_metadata();
  // A file without a summary or without chunks is as whole as others, if nothing in it is damaged.
  const bool is_torn = !found.has_data_end || !found.damages.empty();
  const bool is_plain = why == kNoSummary || !loose_.empty();
  if (is_plain && !is_torn) return;
  damage_ = path_.string() + " is damaged: " + why + "; its whole chunks hold " +
            std::to_string(summary_.statistics.message_count) + " messages";
}

bool Reader::read_attachments() {
  for (const AttachmentIndex& index : summary_.attachments) {
    if (index.offset >= size()) return false;
    const auto record = first_record(file_.bytes().subspan(index.offset));
    if (!record || record->opcode != Opcode::kAttachment) return false;
    const auto view = parse_attachment(record->content);
    if (!view || !view->is_intact) return false;
    attachments_.push_back(view->attachment);
  }
  return true;
}

bool Reader::read_metadata() {
  for (const MetadataIndex& index : summary_.metadata) {
    if (index.offset >= size()) return false;
    const auto record = first_record(file_.bytes().subspan(index.offset));
    if (!record || record->opcode != Opcode::kMetadata) return false;
    auto metadata = parse_metadata(record->content);
    if (!metadata) return false;
    metadata_.push_back(std::move(*metadata));
  }
  return true;
}

const Schema* Reader::schema_of(const Channel& channel) const noexcept {
  const auto found = summary_.schemas.find(channel.schema_id);
  return found == summary_.schemas.end() ? nullptr : &found->second;
}

MessageCursor Reader::messages(const MessageFilter& filter) const {
  MessageCursor::Source source{file_.bytes(), summary_.chunks, loose_, {}};
  for (const auto& [id, channel] : summary_.channels) {
    if (matches_topic(channel.topic, filter.topics)) source.channels.insert(id);
  }
  return {std::move(source), filter};
}

}  // namespace cordis::mcap
