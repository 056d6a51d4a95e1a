// node/dds/missing_numbers.h -- which messages of writers never came, by their numbers.
#pragma once

#include <cstdint>
#include <map>

#include "node/dds/participant.h"

namespace cordis::dds {

/// Follows the numbers of the writers of one topic. Where a topic is exclusive, DDS keeps back what a
/// writer says after a stronger one has spoken of the same key: that is not missing.
class MissingNumbers {
 public:
  explicit MissingNumbers(bool is_exclusive) : is_exclusive_(is_exclusive) {}

  struct Noted {
    bool is_first = false;      ///< its writer has written nothing here before
    std::uint64_t missing = 0;  ///< numbers since the writer's message before, or from 1 on
  };

  /// Notes a message that came. @param sequence  its number, from 1
  Noted note(const WriterId& writer, std::uint32_t strength, std::uint32_t key,
             std::uint64_t sequence);

 private:
  struct Writer {
    std::uint32_t strength = 0;
    std::uint64_t sequence = 0;                   // of its last message; 0: none yet
    std::map<std::uint32_t, std::uint64_t> keys;  // with the arrival of the last message of each
  };
  bool has_yielded(const Writer& writer) const;

  const bool is_exclusive_;
  std::map<WriterId, Writer> writers_;
  std::uint64_t arrivals_ = 0;
};

}  // namespace cordis::dds
