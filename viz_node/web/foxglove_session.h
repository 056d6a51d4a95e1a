// viz_node/web/foxglove_session.h -- the connection to one Foxglove client.
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <spdlog/spdlog.h>

#include "node/time.h"
#include "viz_node/foxglove_client.h"
#include "viz_node/web/server_state.h"
#include "viz_node/web/websocket_session.h"

namespace cordis::viz {

inline constexpr std::size_t kLongestFromFoxglove = 16384;  // [bytes]

/// One Foxglove client. Sends one message at a time, whatever is most due; reads subscriptions.
class FoxgloveSession : public std::enable_shared_from_this<FoxgloveSession> {
 public:
  FoxgloveSession(beast::tcp_stream&& stream, ConnectionSlot&& slot, ServerState& state)
      : stream_(std::move(stream)),
        slot_(std::move(slot)),
        state_(state),
        client_(*state.topics, state.server_info) {}
  ~FoxgloveSession() { state_.foxglove_clients.erase(this); }
  FoxgloveSession(const FoxgloveSession&) = delete;
  FoxgloveSession& operator=(const FoxgloveSession&) = delete;

  /// @param protocol  the subprotocol that is spoken, one of those offered
  void start(const http::request<http::empty_body>& request, const std::string& protocol) {
    prepare(stream_, kLongestFromFoxglove);
    stream_.set_option(
        websocket::stream_base::decorator([protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    stream_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return;
      self->state_.foxglove_clients.insert(self.get());
      self->read();
      self->pump();
    });
  }

  /// Sends the next thing that is due, unless a message is still on its way into the socket.
  void pump() noexcept {
    try {
      if (writing_) return;
      if (const auto message = client_.next(node::monotonic_nsec())) send(*message);
    } catch (const std::exception& error) {
      if (state_.closures.record(node::monotonic_nsec()))
        spdlog::warn("closed the connection to Foxglove: {}", error.what());
      leave();
    }
  }

 private:
  void send(const FoxgloveClient::Message& message) {
    writing_ = true;
    stream_.binary(!message.is_text);
    const std::array<asio::const_buffer, 2> parts{
        asio::buffer(message.head.data(), message.head.size()),
        asio::buffer(message.body.data(), message.body.size())};
    stream_.async_write(parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
      self->writing_ = false;
      if (error) return self->leave();
      self->pump();
    });
  }

  void read() {
    stream_.async_read(incoming_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->leave();
      self->client_.receive(beast::buffers_to_string(self->incoming_.data()),
                            self->stream_.got_text());
      self->incoming_.consume(self->incoming_.size());
      self->pump();
      self->read();
    });
  }

  void leave() {
    state_.foxglove_clients.erase(this);
    beast::get_lowest_layer(stream_).close();
  }

  websocket::stream<beast::tcp_stream> stream_;
  ConnectionSlot slot_;
  ServerState& state_;
  FoxgloveClient client_;
  beast::flat_buffer incoming_;
  bool writing_ = false;
};

}  // namespace cordis::viz
