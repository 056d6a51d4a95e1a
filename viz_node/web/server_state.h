// viz_node/web/server_state.h -- what all connections of the server share.
//
// Boost.Beast takes half a minute to compile: the headers server_*.h are for server.cpp alone.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_set>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "node/latency.h"
#include "node/repeated_event.h"
#include "viz_node/pointer_server.h"
#include "viz_node/scene_mirror.h"
#include "viz_node/topic_board.h"
#include "viz_node/web/access_token.h"
#include "viz_node/web/request_filter.h"

namespace cordis::viz {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

inline constexpr auto kRequestTimeout = std::chrono::seconds(10);  // until all of it has come
inline constexpr auto kReplyTimeout = std::chrono::seconds(60);    // until all of it has gone
inline constexpr std::size_t kMaxRequests = 64;                    // connections that are no page
inline constexpr std::size_t kMaxPages = 64;

class FoxgloveSession;
class HttpSession;
class WebSocketSession;

/// What all connections share. Lives in the server's thread, but for the latency.
struct ServerState {
  ServerState(SceneMirror& mirrored, PointerServer& server,
              std::function<void(const PageCommand&)> call)
      : mirror(mirrored), pointers(server), execute(std::move(call)) {}

  SceneMirror& mirror;
  PointerServer& pointers;
  std::function<void(const PageCommand&)> execute;
  std::string hello;                          // to a page that may command
  std::string hello_view_only;                // to one that may not
  std::shared_ptr<const std::string> status;  // newest text
  std::uint64_t status_number = 0;
  AcceptedHosts hosts;
  std::string token;          ///< in the address of a page that may command; empty: every page may
  bool is_view_only = false;  ///< no page may command
  std::size_t connections = 0;
  /// Connections that are no page: those that wait for a request first, the oldest of them first.
  std::map<std::pair<bool, std::uint64_t>, HttpSession*> requests;
  std::uint64_t request_count = 0;
  std::uint32_t page_count = 0;  ///< pages that ever came: their numbers
  std::unordered_set<WebSocketSession*> clients;
  TopicBoard* topics = nullptr;  ///< what Foxglove reads; set if `hosts.foxglove` is
  std::string server_info;       ///< the first message to Foxglove
  std::unordered_set<FoxgloveSession*> foxglove_clients;
  node::RepeatedEvent closures{"closed connections to pages"};

  std::size_t pages() const noexcept { return connections - requests.size(); }

  bool may_command(std::string_view target) const noexcept {
    return !is_view_only && (token.empty() || is_same_secret(token_of(target), token));
  }

  mutable std::mutex latency_mutex;
  node::LatencyHistogram latency;
};

/// Counts a connection for as long as it lives, as HTTP or as WebSocket.
class ConnectionSlot {
 public:
  explicit ConnectionSlot(ServerState& state) noexcept : state_(&state) { ++state_->connections; }
  ConnectionSlot(ConnectionSlot&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
  ConnectionSlot& operator=(ConnectionSlot&&) = delete;
  ~ConnectionSlot() {
    if (state_ != nullptr) --state_->connections;
  }

 private:
  ServerState* state_;
};

}  // namespace cordis::viz
