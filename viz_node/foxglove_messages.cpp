// viz_node/foxglove_messages.cpp
#include "viz_node/foxglove_messages.h"

#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "idl/schema_text.h"

namespace cordis::viz {
namespace {

using Json = nlohmann::json;

constexpr std::uint8_t kMessageData = 1;  // opcode

/// Names of topics may be any bytes.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_little_endian(std::uint64_t value, std::span<std::uint8_t> bytes) noexcept {
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(value & 0xff);
    value >>= 8;
  }
}

std::optional<std::uint32_t> number_of(const Json& json) {
  if (!json.is_number_unsigned()) return std::nullopt;
  const auto number = json.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

FoxgloveRequest problem(std::string text) {
  return {.subscribe = {}, .unsubscribe = {}, .problem = std::move(text)};
}

FoxgloveRequest read_subscribe(const Json& subscriptions) {
  FoxgloveRequest request;
  if (!subscriptions.is_array()) return problem("'subscriptions' is a list");
  for (const Json& each : subscriptions) {
    const auto id = number_of(each.is_object() ? each.value("id", Json()) : Json());
    const auto channel = number_of(each.is_object() ? each.value("channelId", Json()) : Json());
    if (!id || !channel) return problem("a subscription has an 'id' and a 'channelId' of 32 bits");
    request.subscribe.push_back({*id, *channel});
  }
  return request;
}

FoxgloveRequest read_unsubscribe(const Json& ids) {
  FoxgloveRequest request;
  if (!ids.is_array()) return problem("'subscriptionIds' is a list");
  for (const Json& each : ids) {
    const auto id = number_of(each);
    if (!id) return problem("'subscriptionIds' lists numbers of 32 bits");
    request.unsubscribe.push_back(*id);
  }
  return request;
}

}  // namespace

std::string server_info_text(const std::string& session, std::uint64_t epoch) {
  return text_of({{"op", "serverInfo"},
                  {"name", "Cordis session " + session},
                  {"capabilities", Json::array()},
                  {"sessionId", std::to_string(epoch)}});
}

std::string advertise_text(std::span<const TopicChannel> channels) {
  Json list = Json::array();
  for (const TopicChannel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", msg::kMessageEncoding},
                    {"schemaName", channel.type},
                    {"schema", msg::schema_text_of(channel.type)},
                    {"schemaEncoding", msg::kSchemaEncoding}});
  }
  return text_of({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string unadvertise_text(std::span<const std::uint32_t> channels) {
  return text_of({{"op", "unadvertise"}, {"channelIds", Json(channels)}});
}

std::string status_text(FoxgloveLevel level, std::string_view message, std::string_view id) {
  Json status{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}};
  if (!id.empty()) status["id"] = id;
  return text_of(status);
}

std::array<std::uint8_t, kFoxgloveHeaderBytes> message_header(
    std::uint32_t subscription, std::uint64_t log_time_nsec) noexcept {
  std::array<std::uint8_t, kFoxgloveHeaderBytes> header{kMessageData};
  write_little_endian(subscription, std::span(header).subspan(1, 4));
  write_little_endian(log_time_nsec, std::span(header).subspan(5, 8));
  return header;
}

FoxgloveRequest read_foxglove_request(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return problem("a message is a JSON object with 'op'");
  const Json op = json.value("op", Json());
  if (op == "subscribe") return read_subscribe(json.value("subscriptions", Json()));
  if (op == "unsubscribe") return read_unsubscribe(json.value("subscriptionIds", Json()));
  return problem("this server is to read from: it takes 'subscribe' and 'unsubscribe' alone");
}

}  // namespace cordis::viz
