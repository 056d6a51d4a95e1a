// viz_node/foxglove_client.h -- what one Foxglove client is sent, and what it may ask for.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "viz_node/foxglove_messages.h"
#include "viz_node/topic_board.h"

namespace cordis::viz {

/// One client of the Foxglove WebSocket protocol, without its connection. It gets the messages of
/// the channels that it subscribes to, one at a time in the order in which they came. What it is
/// too slow for is left out, and counted in a warning. Memory is bounded by the number of channels.
/// One thread; the caller's clock.
class FoxgloveClient {
 public:
  static constexpr std::int64_t kWarningPeriodNsec = 5'000'000'000;

  struct Message {
    bool is_text = false;
    std::span<const std::uint8_t> head;  ///< stay until next() is called again
    std::span<const std::uint8_t> body;
  };

  /// @param board        outlives the client
  /// @param server_info  the first message
  FoxgloveClient(TopicBoard& board, std::string server_info);
  ~FoxgloveClient();
  FoxgloveClient(const FoxgloveClient&) = delete;
  FoxgloveClient& operator=(const FoxgloveClient&) = delete;

  /// Takes a message of the client.
  void receive(std::string_view message, bool is_text);

  /// The next thing that is due, which counts as sent; nothing when the client has it all.
  std::optional<Message> next(std::int64_t now_nsec);

  /// Messages that passed the client by since it came.
  std::uint64_t left_out() const noexcept { return left_out_; }

 private:
  struct Subscription {
    std::uint32_t id = 0;
    std::uint64_t last_index = 0;  // of the message sent last, or before the subscription
    std::deque<std::shared_ptr<const TopicMessage>> kept;  // to send first
  };

  void subscribe(const FoxgloveSubscription& wanted);
  void unsubscribe(std::uint32_t id);
  void end(std::uint32_t channel);
  void refuse(const std::string& why) { refusal_ = status_text(FoxgloveLevel::kError, why); }

  Message text(std::string text);
  Message data(std::shared_ptr<const TopicMessage> message, std::uint32_t subscription);
  std::optional<Message> next_of_channels();
  std::optional<Message> next_warning(std::int64_t now_nsec);
  std::optional<Message> next_kept();
  std::optional<Message> next_message();

  TopicBoard& board_;
  std::string server_info_;                               // empty once it is sent
  std::string refusal_;                                   // the newest alone
  std::shared_ptr<const TopicBoard::Channels> channels_;  // as advertised; null before
  std::set<std::uint32_t> advertised_;                    // their ids
  std::map<std::uint32_t, Subscription> subscriptions_;   // by channel
  std::uint64_t number_ = 0;                              // of the message looked at last
  std::uint64_t left_out_ = 0;
  std::uint64_t warned_of_ = 0;
  std::optional<std::int64_t> warned_nsec_;
  // What the message on its way is made of.
  std::string text_;
  std::array<std::uint8_t, kFoxgloveHeaderBytes> header_{};
  std::shared_ptr<const TopicMessage> message_;
};

}  // namespace cordis::viz
