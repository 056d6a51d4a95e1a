// record_node/last_messages.cpp
#include "record_node/last_messages.h"

#include <algorithm>

#include "node/cdr.h"

namespace cordis::record {
namespace {

constexpr std::uint64_t kFirstSpanNsec = 1'000'000'000;
constexpr std::uint64_t kSpanGrowth = 4;

/// @param depth  payloads to keep of each channel and key
LastMessages search(const mcap::Reader& take, const mcap::MessageFilter& filter, bool has_keys,
                    std::size_t depth, std::vector<std::string>& problems) {
  LastMessages last;
  if (filter.topics.empty()) return last;
  mcap::MessageCursor cursor = take.messages(filter);
  for (mcap::Message message; cursor.next(message);) {
    std::uint32_t key = 0;
    const std::size_t end = std::min(kEncapsulationBytes + sizeof key, message.data.size());
    for (std::size_t i = kEncapsulationBytes; has_keys && i < end; ++i)
      key = key << 8 | std::to_integer<std::uint32_t>(message.data[i]);
    auto& newest = last[{message.channel_id, key}];
    if (newest.size() >= depth) newest.pop_front();
    newest.emplace_back(message.data.begin(), message.data.end());
  }
  problems.insert(problems.end(), cursor.problems().begin(), cursor.problems().end());
  return last;
}

}  // namespace

LastMessages last_of_each_key(const mcap::Reader& take, const std::vector<std::string>& topics,
                              std::uint64_t first_nsec, std::uint64_t last_nsec,
                              std::vector<std::string>& problems) {
  return search(take, {.topics = topics, .start_nsec = first_nsec, .end_nsec = last_nsec}, true, 1,
                problems);
}

LastMessages last_of_topic(const mcap::Reader& take, const std::string& topic, std::size_t depth,
                           std::uint64_t last_nsec, std::vector<std::string>& problems) {
  const auto channels = std::ranges::count_if(
      take.channels(), [&topic](const auto& entry) { return entry.second.topic == topic; });
  for (std::uint64_t span_nsec = kFirstSpanNsec;; span_nsec *= kSpanGrowth) {
    const std::uint64_t first = last_nsec > span_nsec ? last_nsec - span_nsec : 0;
    const bool is_all = first <= take.statistics().start_nsec;
    std::vector<std::string> found;
    LastMessages last = search(
        take, {.topics = {topic}, .start_nsec = first, .end_nsec = last_nsec}, false, depth, found);
    const auto full = std::ranges::count_if(
        last, [depth](const auto& entry) { return entry.second.size() == depth; });
    if (full < channels && !is_all) continue;
    problems.insert(problems.end(), found.begin(), found.end());
    return last;
  }
}

}  // namespace cordis::record
