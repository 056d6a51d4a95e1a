// cli/info/take_info.cpp
#include "cli/info/take_info.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/take_file.h"
#include "node/config/count_text.h"

namespace cordis::cli {
namespace {

/// One channel of a take.
struct Topic {
  std::string name;
  std::string type;  // empty: not known
  std::string encoding;
  std::uint64_t message_count = 0;
  double rate_hz = 0.0;  // mean over the take; 0 with fewer than two messages
};

/// The chunks of one compression.
struct Packing {
  std::uint64_t chunk_count = 0;
  std::uint64_t packed = 0;    // [bytes]
  std::uint64_t unpacked = 0;  // [bytes]
};

double duration_of(const mcap::Reader& take) {
  const mcap::Statistics& statistics = take.statistics();
  return 1e-9 * static_cast<double>(statistics.end_nsec - statistics.start_nsec);
}

std::vector<Topic> topics_of(const mcap::Reader& take) {
  std::vector<Topic> topics;
  for (const auto& [id, channel] : take.channels()) {
    Topic topic;
    topic.name = channel.topic;
    if (const mcap::Schema* schema = take.schema_of(channel)) topic.type = schema->name;
    topic.encoding = channel.message_encoding;
    const auto& counts = take.statistics().channel_message_counts;
    const auto count = counts.find(id);
    topic.message_count = count == counts.end() ? 0 : count->second;
    const double duration = duration_of(take);
    if (topic.message_count > 1 && duration > 0.0)
      topic.rate_hz = static_cast<double>(topic.message_count - 1) / duration;
    topics.push_back(std::move(topic));
  }
  std::stable_sort(topics.begin(), topics.end(),
                   [](const Topic& a, const Topic& b) { return a.name < b.name; });
  return topics;
}

std::map<std::string, Packing> packings_of(const mcap::Reader& take) {
  std::map<std::string, Packing> packings;
  for (const mcap::ChunkIndex& chunk : take.chunks()) {
    Packing& packing = packings[chunk.compression.empty() ? "none" : chunk.compression];
    ++packing.chunk_count;
    packing.packed += chunk.compressed_size;
    packing.unpacked += chunk.uncompressed_size;
  }
  return packings;
}

std::string utc(std::uint64_t nsec) {
  const std::chrono::sys_time<std::chrono::nanoseconds> time{
      std::chrono::nanoseconds(static_cast<std::int64_t>(nsec))};
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%F %T}.{:03d} UTC",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)),
                     std::chrono::floor<std::chrono::milliseconds>(time - seconds).count());
}

std::string topic_table(const std::vector<Topic>& topics) {
  std::size_t name_width = 5;
  std::size_t type_width = 4;
  for (const Topic& topic : topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  std::string text = fmt::format("\n{:<{}}  {:<{}}  {:>10}  {:>10}\n", "topic", name_width, "type",
                                 type_width, "messages", "rate");
  for (const Topic& topic : topics) {
    text += fmt::format("{:<{}}  {:<{}}  {:>10}  {:>10}\n", topic.name, name_width,
                        topic.type.empty() ? "-" : topic.type, type_width, topic.message_count,
                        topic.rate_hz > 0.0 ? fmt::format("{:.4g} Hz", topic.rate_hz) : "-");
  }
  return text;
}

std::uint64_t number_in(const mcap::Metadata& words, const std::string& key) {
  const auto found = words.values.find(key);
  return found == words.values.end() ? 0 : std::strtoull(found->second.c_str(), nullptr, 10);
}

std::string missed_text(const record::MissedMessages& missed) {
  std::string text;
  for (const std::string& sentence : record::sentences_of(missed)) text += sentence + "\n";
  return text;
}

}  // namespace

record::MissedMessages missed_in(const mcap::Reader& take) {
  record::MissedMessages missed;
  for (const mcap::Metadata& words : take.metadata()) {
    // A take that was merged has a record per source, `NAME/cordis.recording`.
    if (!words.name.ends_with("cordis.recording")) continue;
    missed.dropped += number_in(words, "messages_dropped");
    missed.lost += number_in(words, "messages_lost");
    missed.before += number_in(words, "messages_before");
    for (const std::string& topic : record::replacing_topics())
      missed.replaced += number_in(words, "lost " + topic);
  }
  return missed;
}

std::string take_text(const mcap::Reader& take) {
  const mcap::Statistics& statistics = take.statistics();
  std::string text = fmt::format("take         {}\n", take.path().string());
  text += fmt::format("size         {}\n", size_text(take.size()));
  if (!take.library().empty()) text += fmt::format("written by   {}\n", take.library());
  if (!take.is_whole()) text += "state        damaged: what follows is about its whole chunks\n";
  if (statistics.message_count > 0) {
    text += fmt::format("duration     {:.3f} s\n", duration_of(take));
    text += fmt::format("start        {}\n", utc(statistics.start_nsec));
  }
  text += fmt::format("messages     {}\n", statistics.message_count);
  for (const auto& [name, packing] : packings_of(take)) {
    text += fmt::format("chunks       {} of {}: {} for {}\n", packing.chunk_count, name,
                        size_text(packing.packed), size_text(packing.unpacked));
  }
  for (const mcap::Attachment& attachment : take.attachments()) {
    text += fmt::format("attachment   {} ({}, {})\n", attachment.name, attachment.media_type,
                        size_text(attachment.data.size()));
  }
  for (const mcap::Metadata& metadata : take.metadata()) {
    text += fmt::format("metadata     {}\n", metadata.name);
    for (const auto& [key, value] : metadata.values)
      text += fmt::format("               {}: {}\n", key, value);
  }
  text += topic_table(topics_of(take));
  const std::string missed = missed_text(missed_in(take));
  return missed.empty() ? text : text + "\n" + missed;
}

std::string take_json(const mcap::Reader& take) {
  const mcap::Statistics& statistics = take.statistics();
  nlohmann::json json{{"take", take.path().string()},
                      {"size_bytes", take.size()},
                      {"library", take.library()},
                      {"whole", take.is_whole()},
                      {"damage", take.damage()},
                      {"duration_s", duration_of(take)},
                      {"start_nsec", statistics.start_nsec},
                      {"end_nsec", statistics.end_nsec},
                      {"messages", statistics.message_count}};
  json["topics"] = nlohmann::json::array();
  for (const Topic& topic : topics_of(take)) {
    json["topics"].push_back({{"name", topic.name},
                              {"type", topic.type},
                              {"encoding", topic.encoding},
                              {"messages", topic.message_count},
                              {"rate_hz", topic.rate_hz}});
  }
  json["chunks"] = nlohmann::json::array();
  for (const auto& [name, packing] : packings_of(take)) {
    json["chunks"].push_back({{"compression", name},
                              {"count", packing.chunk_count},
                              {"compressed_bytes", packing.packed},
                              {"uncompressed_bytes", packing.unpacked}});
  }
  json["attachments"] = nlohmann::json::array();
  for (const mcap::Attachment& attachment : take.attachments()) {
    json["attachments"].push_back({{"name", attachment.name},
                                   {"media_type", attachment.media_type},
                                   {"size_bytes", attachment.data.size()}});
  }
  const record::MissedMessages missed = missed_in(take);
  json["missed"] = {{"dropped", missed.dropped},
                    {"lost", missed.lost},
                    {"replaced", missed.replaced},
                    {"before", missed.before}};
  json["metadata"] = nlohmann::json::object();
  for (const mcap::Metadata& metadata : take.metadata())
    json["metadata"][metadata.name] = metadata.values;
  constexpr int kIndent = 2;  // names in a file of others may be no UTF-8
  return json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace cordis::cli
