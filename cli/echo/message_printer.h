// cli/echo/message_printer.h -- messages as a person reads them, in one of three formats.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "record_node/idl/message_type.h"

namespace cordis::cli {

/// A message, wherever it came from.
struct PrintedMessage {
  std::string topic;
  std::string type_name;
  const record::MessageType* type = nullptr;  ///< null where it is not known
  std::int64_t time_nsec = 0;                 ///< since 1970, of its writer
  std::uint64_t sequence = 0;
  std::span<const std::uint8_t> bytes;
};

/// Prints messages to stdout: yaml, ndjson or csv.
class MessagePrinter {
 public:
  /// @param is_full  in YAML, whole lists and not their beginning
  /// @throws UsageError for another format
  MessagePrinter(std::string format, bool is_full);

  /// @return false when it could not be printed, for its type is not known or it does not fit it;
  /// stderr says why, once for a topic
  bool print(const PrintedMessage& message);

 private:
  std::string text_of(const PrintedMessage& message);
  void report_once(const std::string& topic, const std::string& what);

  std::string format_;
  bool is_full_;
  std::string header_;
  std::set<std::string> reported_;
};

}  // namespace cordis::cli
