// cli/export/message_source.h -- the messages of one topic and one type in a take.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "node/dds/payload.h"
#include "record_node/mcap/reader.h"

namespace cordis::cli {

/// What of a take could not be read, wherever that was found.
struct ReadLoss {
  std::vector<std::string> problems;  ///< a sentence per chunk
  std::uint64_t unreadable = 0;       ///< messages

  bool is_none() const noexcept { return problems.empty() && unreadable == 0; }
};

/// Decodes one message after the other, in the order in which they came.
template <class Message>
class MessageSource {
 public:
  /// @param loss  receives what cannot be read; it and the take outlive this
  MessageSource(const mcap::Reader& take, const std::string& topic, ReadLoss& loss)
      : cursor_(take.messages({.topics = {topic}})), loss_(loss) {}

  /// The next message that is one; false at the end.
  bool next(Message& message) {
    mcap::Message raw;
    while (cursor_.next(raw)) {
      sequence_ = raw.sequence;
      if (dds::decode(raw.data, message)) return true;
      ++loss_.unreadable;
    }
    record_problems();
    return false;
  }

  /// The number that its writer gave the message that next() returned last; 0: it gave none.
  std::uint32_t sequence() const noexcept { return sequence_; }

 private:
  void record_problems() {
    for (const std::string& problem : cursor_.problems()) {
      bool is_known = false;
      for (const std::string& known : loss_.problems) is_known = is_known || known == problem;
      if (!is_known) loss_.problems.push_back(problem);
    }
  }

  mcap::MessageCursor cursor_;
  ReadLoss& loss_;
  std::uint32_t sequence_ = 0;
};

}  // namespace cordis::cli
