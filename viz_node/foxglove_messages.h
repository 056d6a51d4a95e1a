// viz_node/foxglove_messages.h -- the Foxglove WebSocket protocol, as texts and bytes.
//
// Spoken are foxglove.websocket.v1 and foxglove.sdk.v1: they agree in all that is used here. The
// server offers topics to read, and none of the capabilities that the protocol leaves open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viz_node/topic_board.h"

namespace cordis::viz {

/// How grave a status message is.
enum class FoxgloveLevel : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };

/// A subscription as the client asks for it.
struct FoxgloveSubscription {
  std::uint32_t id = 0;  ///< chosen by the client
  std::uint32_t channel = 0;
};

/// What a client asks for.
struct FoxgloveRequest {
  std::vector<FoxgloveSubscription> subscribe;
  std::vector<std::uint32_t> unsubscribe;  ///< ids of subscriptions
  std::string problem;                     ///< a sentence; empty if the request is understood
};

/// The first message to a client.
/// @param epoch  of this life of viz_node: another one has other channels
std::string server_info_text(const std::string& session, std::uint64_t epoch);
/// Channels with the schemas and encodings that takes have.
std::string advertise_text(std::span<const TopicChannel> channels);
std::string unadvertise_text(std::span<const std::uint32_t> channels);
/// @param id  of the message that it replaces; empty: of none
std::string status_text(FoxgloveLevel level, std::string_view message, std::string_view id = {});

inline constexpr std::size_t kFoxgloveHeaderBytes = 13;
/// What stands before the bytes of a message.
std::array<std::uint8_t, kFoxgloveHeaderBytes> message_header(std::uint32_t subscription,
                                                              std::uint64_t log_time_nsec) noexcept;

/// Reads a text of a client. Any text: what is not understood is a problem.
FoxgloveRequest read_foxglove_request(std::string_view text);

}  // namespace cordis::viz
