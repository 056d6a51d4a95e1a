// record_node/missed_messages.h -- what a recorder missed, counted in one way for all who say it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cordis::record {

/// Messages that are not in a take.
struct MissedMessages {
  std::uint64_t dropped = 0;   ///< arrived, and found no room before the disk
  std::uint64_t lost = 0;      ///< never arrived, by the numbers of their writers
  std::uint64_t replaced = 0;  ///< part of `lost`: of writers that keep their newest message alone
  std::uint64_t before = 0;    ///< written before the recorder had found their writers

  /// Messages that the recording could have had: a frame that a newer one has replaced before it was
  /// sent is none of them.
  std::uint64_t losses() const noexcept { return dropped + lost - replaced; }
};

/// The topics whose writers keep their newest message alone: what is lost there was replaced.
const std::vector<std::string>& replacing_topics();

/// True if the topic is one of replacing_topics().
bool is_replacing(const std::string& topic);

/// A line for each count that is not 0.
std::vector<std::string> sentences_of(const MissedMessages& missed);

}  // namespace cordis::record
