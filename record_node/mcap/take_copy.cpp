// record_node/mcap/take_copy.cpp
#include "record_node/mcap/take_copy.h"

#include <algorithm>
#include <optional>

#include "node/cdr.h"
#include "record_node/mcap/file_error.h"
#include "record_node/mcap/topic_glob.h"

namespace cordis::mcap {
namespace {

/// The number of an equal value in a list; none when it is new there.
template <class T>
std::optional<std::uint16_t> number_of(const std::vector<std::pair<T, std::uint16_t>>& list,
                                       const T& value) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&value](const auto& entry) { return entry.first == value; });
  if (found == list.end()) return std::nullopt;
  return found->second;
}

bool says(const Channel& channel, const std::string& words) {
  const auto qos = channel.metadata.find("qos");
  return qos != channel.metadata.end() && qos->second.find(words) != std::string::npos;
}

/// What distinguishes the instances of a topic: its first field, the key where it has one.
std::uint32_t instance_of(const Channel& channel, const Message& message) {
  std::uint32_t key = 0;
  if (says(channel, "keyed: true") && message.data.size() >= kEncapsulationBytes + sizeof key)
    std::memcpy(&key, message.data.data() + kEncapsulationBytes, sizeof key);
  return key;
}

/// The last message of each instance before the start, of topics kept for late joiners.
struct Kept {
  Message message;
  std::vector<std::byte> data;
};

/// Puts the sentences of a cursor behind those that are there, each once.
void add_problems(const MessageCursor& cursor, std::vector<std::string>& problems) {
  for (const std::string& problem : cursor.problems()) {
    if (std::ranges::find(problems, problem) == problems.end()) problems.push_back(problem);
  }
}

std::vector<Kept> kept_before(const Reader& reader, const MessageFilter& filter,
                              std::vector<std::string>& problems) {
  MessageFilter before;
  for (const auto& [id, channel] : reader.channels()) {
    if (says(channel, "durability: true") && matches_topic(channel.topic, filter.topics))
      before.topics.push_back(channel.topic);
  }
  if (before.topics.empty() || filter.start_nsec == 0) return {};
  before.end_nsec = filter.start_nsec - 1;
  std::map<std::pair<std::uint16_t, std::uint32_t>, Kept> newest;
  MessageCursor cursor = reader.messages(before);
  for (Message message; cursor.next(message);) {
    const Channel& channel = reader.channels().at(message.channel_id);
    if (!says(channel, "durability: true")) continue;
    Kept& kept = newest[{message.channel_id, instance_of(channel, message)}];
    kept.data.assign(message.data.begin(), message.data.end());
    kept.message = message;
  }
  add_problems(cursor, problems);
  std::vector<Kept> list;
  for (auto& [key, kept] : newest) list.push_back(std::move(kept));
  return list;
}

}  // namespace

void TakeCopy::require(WriteStatus status) const {
  if (status == WriteStatus::kOk) return;
  throw FileError(writer_.problem().empty() ? writer_.path().string() + " cannot hold a message"
                                            : writer_.problem());
}

std::uint16_t TakeCopy::schema_of(const Reader& reader, std::uint16_t id) {
  const auto found = reader.schemas().find(id);
  if (found == reader.schemas().end()) return 0;
  Schema schema = found->second;
  schema.id = 0;
  if (const auto known = number_of(schemas_, schema)) return *known;
  const std::uint16_t number = writer_.add_schema(schema);
  if (number == 0) require(WriteStatus::kRefused);
  schemas_.emplace_back(std::move(schema), number);
  return number;
}

void TakeCopy::add_descriptions(const Reader& reader, const std::vector<std::string>& topics) {
  for (const auto& [id, original] : reader.channels()) {
    if (!matches_topic(original.topic, topics)) continue;
    Channel channel = original;
    channel.id = 0;
    channel.schema_id = schema_of(reader, original.schema_id);
    auto number = number_of(channels_, channel);
    if (!number) {
      number = writer_.add_channel(channel);
      if (*number == 0) require(WriteStatus::kRefused);
      channels_.emplace_back(std::move(channel), *number);
    }
    numbers_[{&reader, id}] = *number;
  }
  add_attachments(reader);
  add_metadata(reader);
}

void TakeCopy::add_attachments(const Reader& reader) {
  for (Attachment attachment : reader.attachments()) {
    const std::vector<std::byte> data(attachment.data.begin(), attachment.data.end());
    if (const auto known = attachments_.find(attachment.name); known != attachments_.end()) {
      if (known->second == data) continue;
      attachment.name = reader.path().stem().string() + "/" + attachment.name;
    }
    require(writer_.attach(attachment));
    attachments_.emplace(attachment.name, data);
  }
}

void TakeCopy::add_metadata(const Reader& reader) {
  for (Metadata metadata : reader.metadata()) {
    if (const auto known = metadata_.find(metadata.name); known != metadata_.end()) {
      if (known->second == metadata) continue;
      metadata.name = reader.path().stem().string() + "/" + metadata.name;
    }
    require(writer_.add_metadata(metadata));
    metadata_.emplace(metadata.name, metadata);
  }
}

void TakeCopy::add(const Reader& reader, Message message) {
  message.channel_id = numbers_.at({&reader, message.channel_id});
  require(writer_.write(message));
  require(writer_.close_chunk_if_older(message.log_time_nsec));
}

std::vector<std::string> cut(const Reader& reader, const MessageFilter& filter, Writer& writer) {
  TakeCopy copy(writer);
  std::vector<std::string> problems;
  copy.add_descriptions(reader, filter.topics);
  for (Kept& kept : kept_before(reader, filter, problems)) {
    kept.message.data = kept.data;
    kept.message.log_time_nsec = filter.start_nsec;
    copy.add(reader, kept.message);
  }
  MessageCursor cursor = reader.messages(filter);
  for (Message message; cursor.next(message);) copy.add(reader, message);
  add_problems(cursor, problems);
  return problems;
}

std::vector<std::string> merge(const std::vector<const Reader*>& readers, Writer& writer) {
  struct Source {
    const Reader* reader;
    MessageCursor cursor;
    Message message;
  };
  TakeCopy copy(writer);
  std::vector<Source> sources;
  std::vector<std::string> problems;
  const auto go_on = [&problems](Source& source) {
    if (source.cursor.next(source.message)) return true;
    for (const std::string& problem : source.cursor.problems())
      problems.push_back(source.reader->path().string() + ": " + problem);
    return false;
  };
  for (const Reader* reader : readers) {
    copy.add_descriptions(*reader, {});
    Source source{reader, reader->messages(), {}};
    if (go_on(source)) sources.push_back(std::move(source));
  }
  while (!sources.empty()) {
    const auto first =
        std::min_element(sources.begin(), sources.end(), [](const Source& a, const Source& b) {
          return a.message.log_time_nsec < b.message.log_time_nsec;
        });
    copy.add(*first->reader, first->message);
    if (!go_on(*first)) sources.erase(first);
  }
  return problems;
}

}  // namespace cordis::mcap
