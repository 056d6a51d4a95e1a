// record_node/take_writer.cpp
#include "record_node/take_writer.h"

#include <chrono>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "idl/schema_text.h"
#include "node/log_time.h"
#include "record_node/idl/idl_parser.h"
#include "record_node/topic_words.h"

namespace cordis::record {
namespace {

constexpr auto kWritePeriod = std::chrono::milliseconds(50);
constexpr auto kWaitForPlan = std::chrono::milliseconds(500);  // at the end of the take

std::uint64_t utc_nsec() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

std::map<std::string, std::string> known_types(const std::map<std::string, std::string>& idl) {
  std::map<std::string, std::string> types;
  for (const msg::SchemaText& schema : msg::schema_texts()) types.emplace(schema.type, schema.text);
  for (const auto& [source, text] : idl) {
    for (const auto& [name, type] : parse_idl(text, source)) types[name] = text;
  }
  return types;
}

}  // namespace

TakeWriter::TakeWriter(const RecorderConfig& config, PlanReport& plan, SampleQueue& queue,
                       RecordedWriters& writers, FindOrigin find_origin)
    : plan_(plan),
      queue_(queue),
      writers_(writers),
      find_origin_(std::move(find_origin)),
      types_(known_types(config.idl)),
      file_(config.out, mcap::WriterConfig{.compression = config.compression,
                                           .library = std::string("cordis ") + CORDIS_VERSION}) {
  begin(config);
  thread_ = std::thread([this] { loop(); });
}

TakeWriter::~TakeWriter() {
  close();
}

void TakeWriter::begin(const RecorderConfig& config) {
  note(file_.add_metadata({"cordis.session", config.about}));
  for (const AttachedFile& attached : config.attached) {
    note(file_.attach({.name = attached.name,
                       .media_type = attached.media_type,
                       .log_time_nsec = utc_nsec(),
                       .create_time_nsec = attached.changed_nsec,
                       .data = std::as_bytes(std::span(attached.bytes))}));
  }
}

void TakeWriter::attach_plan(std::chrono::milliseconds at_most) {
  const std::optional<std::string> report = plan_.take(at_most);
  if (!report || over_) return;
  note(file_.attach({.name = "plan.txt",
                     .media_type = "text/plain",
                     .log_time_nsec = utc_nsec(),
                     .create_time_nsec = utc_nsec(),
                     .data = std::as_bytes(std::span(*report))}));
}

void TakeWriter::close() {
  if (!thread_.joinable()) return;
  ending_ = true;
  queue_.interrupt();
  thread_.join();
}

std::string TakeWriter::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void TakeWriter::loop() {
  while (!ending_) {
    write_waiting(kWritePeriod);
    attach_plan(std::chrono::milliseconds(0));
  }
  write_waiting(std::chrono::milliseconds(0));
  attach_plan(kWaitForPlan);
  if (plan_.is_under_way())
    spdlog::warn("the plan of the session is not evaluated yet: the take lacks plan.txt");
  end();
}

void TakeWriter::write_waiting(std::chrono::milliseconds at_most) {
  queue_.take(batch_, at_most);
  for (const QueuedSample& sample : batch_.samples) {
    if (!write(sample)) ++writers_.at(sample.channel).dropped;
  }
  if (!over_) note(file_.close_chunk_if_older(utc_nsec()));
  file_bytes_ = file_.size();
}

/// @return false when the message is not in the file
bool TakeWriter::write(const QueuedSample& sample) {
  if (over_) return false;
  RecordedWriter& writer = writers_.at(sample.channel);
  const std::uint16_t channel = channel_of(writer);
  if (channel == 0) return false;
  const auto data = std::as_bytes(batch_.data(sample));
  const std::uint64_t log_nsec =
      writer.log_time.next(sample.log_time_nsec, sample.publish_time_nsec, writer.is_of_loop_here);
  const mcap::WriteStatus status = file_.write({.channel_id = channel,
                                                .sequence = sample.sequence,
                                                .log_time_nsec = log_nsec,
                                                .publish_time_nsec = sample.publish_time_nsec,
                                                .data = data});
  note(status);
  if (status == mcap::WriteStatus::kOk) {
    for (const mcap::Metadata& words : scenes_.read(writer.topic.name, data))
      note(file_.add_metadata(words));
  }
  return status == mcap::WriteStatus::kOk;
}

std::uint16_t TakeWriter::channel_of(RecordedWriter& writer) {
  if (writer.channel != 0) return writer.channel;
  const Origin origin = find_origin_(writer.id);
  writer.is_of_loop_here = origin.is_here && node::is_of_loop(writer.topic.name);
  mcap::Channel channel;
  channel.schema_id = schema_of(writer.topic.type);
  channel.topic = writer.topic.name;
  channel.message_encoding = msg::kMessageEncoding;
  channel.metadata = words_of(writer.topic);
  channel.metadata["writer"] = guid_text(writer.id);
  channel.metadata["process"] = origin.process;
  channel.metadata["partitions"] = guid_text(writer.id) + ":" + origin.partitions;
  writer.channel = file_.add_channel(channel);
  if (writer.channel == 0) note(file_.status());
  return writer.channel;
}

/// 0 for a type of which nothing but its name is known.
std::uint16_t TakeWriter::schema_of(const std::string& type) {
  const auto text = types_.find(type);
  if (text == types_.end()) return 0;
  std::uint16_t& schema = schemas_[type];
  if (schema == 0)
    schema =
        file_.add_schema({.name = type, .encoding = msg::kSchemaEncoding, .data = text->second});
  return schema;
}

void TakeWriter::note(mcap::WriteStatus status) {
  if (status == mcap::WriteStatus::kOk || status == mcap::WriteStatus::kRefused || over_) return;
  over_ = true;
  const std::lock_guard lock(mutex_);
  problem_ = file_.problem();
}

/// What came and is not in the file: a chunk that finds no room takes many messages with it.
void TakeWriter::count_dropped() {
  const auto& stored = file_.statistics().channel_message_counts;
  writers_.for_each([&](RecordedWriter& writer) {
    const auto count = stored.find(writer.channel);
    writer.dropped = writer.messages - (count == stored.end() ? 0 : count->second);
  });
}

/// The words of `cordis.recording`: sums, and each topic that lacks messages.
std::map<std::string, std::string> TakeWriter::counts() const {
  std::map<std::string, std::uint64_t> sums{{"messages_received", 0},
                                            {"messages_dropped", 0},
                                            {"messages_lost", 0},
                                            {"messages_before", 0}};
  const auto add = [&sums](const std::string& what, const std::string& topic, std::uint64_t count) {
    sums["messages_" + what] += count;
    if (count > 0) sums[what + " " + topic] += count;
  };
  std::as_const(writers_).for_each([&](const RecordedWriter& writer) {
    sums["messages_received"] += writer.messages;
    add("dropped", writer.topic.name, writer.dropped);
    add("lost", writer.topic.name, writer.lost);
    add("before", writer.topic.name, writer.before);
  });
  std::map<std::string, std::string> words;
  for (const auto& [key, count] : sums) words[key] = std::to_string(count);
  return words;
}

void TakeWriter::end() {
  note(file_.flush());
  count_dropped();
  note(file_.add_metadata({"cordis.recording", counts()}));
  const mcap::WriteStatus status = file_.close();
  file_bytes_ = file_.size();
  note(status);
  if (status == mcap::WriteStatus::kFailed) {
    failed_ = true;
    const std::lock_guard lock(mutex_);
    problem_ = file_.problem();
  }
}

}  // namespace cordis::record
