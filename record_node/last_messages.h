// record_node/last_messages.h -- the messages that a writer would have kept at a time of a take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "record_node/mcap/reader.h"

namespace cordis::record {

/// The newest payloads of each channel and key, oldest first.
using LastMessages =
    std::map<std::pair<std::uint16_t, std::uint32_t>, std::deque<std::vector<std::byte>>>;

/// The newest message of each channel and key within these log times, both included. The key is the
/// first member of the message. It reads each chunk that has one of the topics.
/// @param problems  gains a sentence for each chunk that could not be read
LastMessages last_of_each_key(const mcap::Reader& take, const std::vector<std::string>& topics,
                              std::uint64_t first_nsec, std::uint64_t last_nsec,
                              std::vector<std::string>& problems);

/// The newest `depth` messages of each channel of a topic without keys, up to this log time.
/// It reads chunks from the newest on, and stops once each channel has enough.
LastMessages last_of_topic(const mcap::Reader& take, const std::string& topic, std::size_t depth,
                           std::uint64_t last_nsec, std::vector<std::string>& problems);

}  // namespace cordis::record
