// cli/echo/take_echo.cpp
#include "cli/echo/take_echo.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/exit_code.h"
#include "cli/live_output.h"
#include "cli/message_types.h"
#include "cli/take_file.h"
#include "node/config/count_text.h"
#include "node/config/regular_file.h"
#include "node/stop.h"
#include "node/terminal_text.h"
#include "record_node/idl/idl_parser.h"
#include "record_node/mcap/topic_glob.h"

namespace cordis::cli {
namespace {

/// The types of the channels of a take: each as its schema says, which may be of another version
/// than this program.
class ChannelTypes {
 public:
  ChannelTypes(const mcap::Reader& take, const std::vector<std::string>& idl_files)
      : take_(take),
        named_(idl_files.empty() ? record::MessageTypes{} : known_message_types(idl_files)) {}

  struct Known {
    std::string name;
    record::MessageTypePtr type;
  };

  const Known& of(std::uint16_t channel_id) {
    const auto found = known_.find(channel_id);
    if (found != known_.end()) return found->second;
    return known_.emplace(channel_id, read(take_.channels().at(channel_id))).first->second;
  }

 private:
  Known read(const mcap::Channel& channel) const {
    Known known;
    const mcap::Schema* const schema = take_.schema_of(channel);
    if (schema != nullptr) known.name = schema->name;
    if (channel.message_encoding != "cdr") return known;
    if (schema != nullptr && schema->encoding == "omgidl") {
      try {
        known.type = type_in(record::parse_idl(schema->data, schema->name), known.name);
      } catch (const record::IdlError&) {  // that of --idl, where there is one
      }
    }
    if (known.name.empty()) known.name = type_name_of(channel);
    if (known.type == nullptr) known.type = type_in(named_, known.name);
    return known;
  }

  static record::MessageTypePtr type_in(const record::MessageTypes& types,
                                        const std::string& name) {
    const auto found = types.find(name);
    return found == types.end() ? nullptr : found->second;
  }

  /// A recorder without the schema writes the name of the type beside the channel.
  static std::string type_name_of(const mcap::Channel& channel) {
    const auto type = channel.metadata.find("type");
    return type == channel.metadata.end() ? "" : type->second;
  }

  const mcap::Reader& take_;
  record::MessageTypes named_;
  std::map<std::uint16_t, Known> known_;
};

std::vector<std::string> echoed_topics(const std::string& topic) {
  return topic.empty() ? std::vector<std::string>{} : std::vector<std::string>{topic};
}

void check_topic(const mcap::Reader& take, const std::string& topic) {
  const auto& channels = take.channels();
  const bool fits = std::ranges::any_of(channels, [&topic](const auto& entry) {
    return mcap::matches_topic(entry.second.topic, echoed_topics(topic));
  });
  if (fits) return;
  const std::string file = take.path().string();
  throw UsageError(topic.empty()
                       ? fmt::format("{} has no topic", file)
                       : fmt::format("{} has no topic '{}'; `cordis info` lists those that it has",
                                     file, topic));
}

}  // namespace

int echo_take(const TakeEcho& wanted, MessagePrinter& printer) {
  const std::unique_ptr<mcap::Reader> take = open_take("echo", wanted.take);
  check_topic(*take, wanted.topic);
  ChannelTypes types(*take, wanted.idl_files);
  mcap::MessageCursor cursor = take->messages({.topics = echoed_topics(wanted.topic)});
  std::uint64_t printed = 0;
  std::uint64_t refused = 0;
  mcap::Message message;
  while (!node::stop_requested() && (!wanted.count || printed < *wanted.count) &&
         cursor.next(message)) {
    const ChannelTypes::Known& known = types.of(message.channel_id);
    const bool is_printed =
        printer.print({.topic = take->channels().at(message.channel_id).topic,
                       .type_name = known.name,
                       .type = known.type.get(),
                       .time_nsec = static_cast<std::int64_t>(message.publish_time_nsec),
                       .sequence = message.sequence,
                       .bytes = {reinterpret_cast<const std::uint8_t*>(message.data.data()),
                                 message.data.size()}});
    ++(is_printed ? printed : refused);
    if (!flush_output()) return kSuccess;  // its reader has gone
  }
  for (const std::string& problem : cursor.problems())
    node::print_text(stderr, fmt::format("cordis echo: {}\n", problem));
  if (refused > 0)
    std::fprintf(stderr, "cordis echo: %s left out\n",
                 config::count_text(refused, "message").c_str());
  if (refused > 0 && printed == 0) return kFailure;
  const bool is_whole = take->is_whole() && cursor.problems().empty() && refused == 0;
  return is_whole ? kSuccess : kLoss;
}

}  // namespace cordis::cli
