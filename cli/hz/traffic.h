// cli/hz/traffic.h -- what comes on a topic, from table to table.
#pragma once

#include <cstdint>
#include <map>

#include "cli/topic_listener.h"

namespace cordis::cli {

/// Counts the messages of a topic since the last table, by the time at which they came. The first
/// message of a writer begins its time: it is in no rate. So is nothing that was written before it
/// came: a late reader is sent again what is kept for it, at once.
class Traffic {
 public:
  void add(const ReceivedMessage& message);

  /// Until now, since the last table or the first message of each writer.
  /// @param now_nsec  since 1970, as the reception of a message
  double messages_per_s(std::int64_t now_nsec) const;
  double bytes_per_s(std::int64_t now_nsec) const;
  double shortest_s() const noexcept { return shortest_s_; }  ///< between two of one writer
  double longest_s() const noexcept { return longest_s_; }    ///< likewise
  /// Numbers of the writers that did not come.
  std::uint64_t missing() const noexcept { return missing_; }

  /// A table was made.
  void begin_again(std::int64_t now_nsec);

 private:
  struct Writer {
    std::int64_t first_nsec = 0;
    std::int64_t last_nsec = 0;   // of those that are counted; 0: none
    std::int64_t since_nsec = 0;  // the rate counts from here
    std::uint64_t messages = 0;   // after that
    std::uint64_t bytes = 0;      // likewise
  };
  double per_s(std::uint64_t Writer::*count, std::int64_t now_nsec) const;

  std::map<dds::WriterId, Writer> writers_;
  std::uint64_t missing_ = 0;
  std::uint64_t intervals_ = 0;
  double shortest_s_ = 0.0;
  double longest_s_ = 0.0;
};

}  // namespace cordis::cli
