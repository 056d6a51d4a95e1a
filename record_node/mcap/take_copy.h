// record_node/mcap/take_copy.h -- takes made out of others: a cut, or several merged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "record_node/mcap/message_cursor.h"
#include "record_node/mcap/reader.h"
#include "record_node/mcap/writer.h"

namespace cordis::mcap {

/// Writes what several takes have into one. Schemas and channels that are equal become one; files and
/// metadata of the same name and other contents get the name of their take before theirs.
class TakeCopy {
 public:
  explicit TakeCopy(Writer& writer) : writer_(writer) {}

  /// Schemas, channels that fit `topics`, attachments and metadata.
  /// @throws FileError when the writer has no room
  void add_descriptions(const Reader& reader, const std::vector<std::string>& topics);
  /// A message of a take whose descriptions are there. @throws FileError as above
  void add(const Reader& reader, Message message);

 private:
  std::uint16_t schema_of(const Reader& reader, std::uint16_t id);
  void add_attachments(const Reader& reader);
  void add_metadata(const Reader& reader);
  void require(WriteStatus status) const;

  Writer& writer_;
  std::vector<std::pair<Schema, std::uint16_t>> schemas_;  // without number; its number here
  std::vector<std::pair<Channel, std::uint16_t>> channels_;
  std::map<std::pair<const Reader*, std::uint16_t>, std::uint16_t> numbers_;  // of channels
  std::map<std::string, std::vector<std::byte>> attachments_;
  std::map<std::string, Metadata> metadata_;
};

/// Copies the wanted messages of a take. Topics kept for late joiners (`durability: true` in the
/// `qos` of their channel) begin with their last message before the start: a cut explains itself.
/// @return what of the take could not be read, a sentence per chunk. @throws FileError
[[nodiscard]] std::vector<std::string> cut(const Reader& reader, const MessageFilter& filter,
                                           Writer& writer);

/// Copies all messages of several takes, by log time.
/// @return what of the takes could not be read, a sentence per chunk. @throws FileError
[[nodiscard]] std::vector<std::string> merge(const std::vector<const Reader*>& readers,
                                             Writer& writer);

}  // namespace cordis::mcap
