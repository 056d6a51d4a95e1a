// record_node/mcap/reader.h -- reads a take, whole or torn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "record_node/mcap/mapped_file.h"
#include "record_node/mcap/message_cursor.h"
#include "record_node/mcap/records.h"
#include "record_node/mcap/summary.h"

namespace cordis::mcap {

/// Opens a file and knows what it holds: from its summary, or where that is absent or damaged from
/// a scan of all that is whole. It never changes the file. Cost of opening: that of the summary, or
/// of the whole file.
class Reader {
 public:
  /// @throws FileError when it cannot be read or is no MCAP file
  explicit Reader(const std::filesystem::path& path);

  /// One sentence about what is damaged and how much is left; empty for a whole take.
  const std::string& damage() const noexcept { return damage_; }
  bool is_whole() const noexcept { return damage_.empty(); }

  const std::filesystem::path& path() const noexcept { return path_; }
  std::uint64_t size() const noexcept { return file_.bytes().size(); }  ///< file size [bytes]
  /// The program that wrote it.
  const std::string& library() const noexcept { return library_; }
  const std::map<std::uint16_t, Schema>& schemas() const noexcept { return summary_.schemas; }
  const std::map<std::uint16_t, Channel>& channels() const noexcept { return summary_.channels; }
  const Statistics& statistics() const noexcept { return summary_.statistics; }
  const std::vector<ChunkIndex>& chunks() const noexcept { return summary_.chunks; }
  /// Their data live as long as the reader.
  const std::vector<Attachment>& attachments() const noexcept { return attachments_; }
  const std::vector<Metadata>& metadata() const noexcept { return metadata_; }
  /// The schema of a channel; nullptr when it has none.
  const Schema* schema_of(const Channel& channel) const noexcept;

  /// The wanted messages by log time. The reader outlives the cursor.
  MessageCursor messages(const MessageFilter& filter = {}) const;

 private:
  void scan_file(const std::string& why);
  void read_library();
  bool read_attachments();
  bool read_metadata();

  std::filesystem::path path_;
  MappedFile file_;
  std::string library_;
  std::string damage_;
  Summary summary_;
  std::vector<MessageEntry> loose_;
  std::vector<Attachment> attachments_;
  std::vector<Metadata> metadata_;
};

}  // namespace cordis::mcap
