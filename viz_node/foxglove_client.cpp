// viz_node/foxglove_client.cpp
#include "viz_node/foxglove_client.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace cordis::viz {

FoxgloveClient::FoxgloveClient(TopicBoard& board, std::string server_info)
    : board_(board), server_info_(std::move(server_info)) {}

FoxgloveClient::~FoxgloveClient() {
  for (const auto& [channel, subscription] : subscriptions_) board_.unsubscribe(channel);
}

void FoxgloveClient::receive(std::string_view message, bool is_text) {
  if (!is_text) return refuse("this server is to read from: it takes no messages of data");
  const FoxgloveRequest request = read_foxglove_request(message);
  if (!request.problem.empty()) return refuse(request.problem);
  for (const FoxgloveSubscription& wanted : request.subscribe) subscribe(wanted);
  for (const std::uint32_t id : request.unsubscribe) unsubscribe(id);
}

void FoxgloveClient::subscribe(const FoxgloveSubscription& wanted) {
  const std::string channel = "channel " + std::to_string(wanted.channel);
  if (subscriptions_.contains(wanted.channel))
    return refuse(channel + " has a subscription of this client already");
  if (std::ranges::any_of(subscriptions_,
                          [&wanted](const auto& entry) { return entry.second.id == wanted.id; }))
    return refuse("another subscription has the id " + std::to_string(wanted.id));
  auto start = board_.subscribe(wanted.channel);
  if (!start) return refuse("there is no " + channel);
  subscriptions_[wanted.channel] = {.id = wanted.id,
                                    .last_index = start->last_index,
                                    .kept = {std::make_move_iterator(start->kept.begin()),
                                             std::make_move_iterator(start->kept.end())}};
}

/// An id that is not in use is no error: its channel may have ended meanwhile.
void FoxgloveClient::unsubscribe(std::uint32_t id) {
  const auto found = std::ranges::find_if(
      subscriptions_, [id](const auto& entry) { return entry.second.id == id; });
  if (found != subscriptions_.end()) end(found->first);
}

void FoxgloveClient::end(std::uint32_t channel) {
  if (subscriptions_.erase(channel) > 0) board_.unsubscribe(channel);
}

std::optional<FoxgloveClient::Message> FoxgloveClient::next(std::int64_t now_nsec) {
  if (!server_info_.empty()) return text(std::exchange(server_info_, {}));
  if (!refusal_.empty()) return text(std::exchange(refusal_, {}));
  if (auto channels = next_of_channels()) return channels;
  if (auto warning = next_warning(now_nsec)) return warning;
  if (auto kept = next_kept()) return kept;
  return next_message();
}

FoxgloveClient::Message FoxgloveClient::text(std::string text) {
  text_ = std::move(text);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text_.data());
  return {.is_text = true, .head = {bytes, text_.size()}, .body = {}};
}

FoxgloveClient::Message FoxgloveClient::data(std::shared_ptr<const TopicMessage> message,
                                             std::uint32_t subscription) {
  message_ = std::move(message);
  header_ = message_header(subscription, message_->log_time_nsec);
  return {.is_text = false, .head = header_, .body = message_->bytes};
}

/// First what is gone, then what is new. The first list of channels is sent even if it is empty.
std::optional<FoxgloveClient::Message> FoxgloveClient::next_of_channels() {
  auto now = board_.channels();
  if (now == channels_) return std::nullopt;
  std::vector<std::uint32_t> gone;
  for (const std::uint32_t id : advertised_) {
    if (!std::ranges::binary_search(*now, id, {}, &TopicChannel::id)) gone.push_back(id);
  }
  if (!gone.empty()) {
    for (const std::uint32_t id : gone) {
      advertised_.erase(id);
      end(id);
    }
    return text(unadvertise_text(gone));
  }
  std::vector<TopicChannel> added;
  for (const TopicChannel& channel : *now) {
    if (advertised_.insert(channel.id).second) added.push_back(channel);
  }
  const bool is_first = channels_ == nullptr;
  channels_ = std::move(now);
  if (added.empty() && !is_first) return std::nullopt;
  return text(advertise_text(added));
}

std::optional<FoxgloveClient::Message> FoxgloveClient::next_warning(std::int64_t now_nsec) {
  if (left_out_ == warned_of_) return std::nullopt;
  if (warned_nsec_ && now_nsec - *warned_nsec_ < kWarningPeriodNsec) return std::nullopt;
  warned_of_ = left_out_;
  warned_nsec_ = now_nsec;
  return text(status_text(FoxgloveLevel::kWarning,
                          std::to_string(left_out_) +
                              " messages were left out: this connection is too slow for what it "
                              "subscribes to",
                          "left out"));
}

std::optional<FoxgloveClient::Message> FoxgloveClient::next_kept() {
  for (auto& [channel, subscription] : subscriptions_) {
    if (subscription.kept.empty()) continue;
    auto message = std::move(subscription.kept.front());
    subscription.kept.pop_front();
    return data(std::move(message), subscription.id);
  }
  return std::nullopt;
}

std::optional<FoxgloveClient::Message> FoxgloveClient::next_message() {
  if (subscriptions_.empty()) return std::nullopt;
  auto message = board_.next_after(number_, [this](const TopicMessage& each) {
    const auto found = subscriptions_.find(each.channel);
    return found != subscriptions_.end() && each.index > found->second.last_index;
  });
  if (message == nullptr) return std::nullopt;
  Subscription& subscription = subscriptions_.at(message->channel);
  left_out_ += message->index - subscription.last_index - 1;
  subscription.last_index = message->index;
  return data(std::move(message), subscription.id);
}

}  // namespace cordis::viz
