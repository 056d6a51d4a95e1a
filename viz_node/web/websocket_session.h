// viz_node/web/websocket_session.h -- the connection to one page.
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/time.h"
#include "viz_node/page_text.h"
#include "viz_node/web/send_queue.h"

namespace cordis::viz {

inline constexpr auto kSilenceTimeout = std::chrono::seconds(30);
inline constexpr std::size_t kLongestFromClient = 1024;  // [bytes]

/// Makes a connection ready to be accepted as a WebSocket.
/// @param longest  message that the client may send [bytes]
inline void prepare(websocket::stream<beast::tcp_stream>& stream, std::size_t longest) {
  beast::get_lowest_layer(stream).expires_never();
  stream.set_option(websocket::stream_base::timeout{kRequestTimeout, kSilenceTimeout,
                                                    /*keep_alive_pings=*/true});
  stream.read_message_max(longest);
  stream.auto_fragment(false);
}

/// One page. Sends one message at a time, whatever is most due; reads acknowledgements and
/// commands.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  /// @param may_command  whether its commands and its hand count
  /// @param every        of so many frames it gets one
  WebSocketSession(beast::tcp_stream&& stream, ConnectionSlot&& slot, ServerState& state,
                   bool may_command, std::uint32_t every)
      : stream_(std::move(stream)),
        slot_(std::move(slot)),
        state_(state),
        page_(++state.page_count),
        may_command_(may_command),
        queue_(state, page_, may_command, every) {}
  ~WebSocketSession() {
    state_.clients.erase(this);
    if (drags_) state_.pointers.leave(page_, node::monotonic_nsec());
    if (joined_) spdlog::debug("a page left, {} frames passed it by", queue_.credit().dropped());
  }
  WebSocketSession(const WebSocketSession&) = delete;
  WebSocketSession& operator=(const WebSocketSession&) = delete;

  void start(const http::request<http::empty_body>& request) {
    prepare(stream_, kLongestFromClient);
    stream_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return;
      self->joined_ = true;
      self->state_.clients.insert(self.get());
      self->read();
      self->pump();
    });
  }

  /// Sends the next thing that is due, unless a message is still on its way into the socket.
  /// A page that cannot be sent what is due (no memory) is let go of, and comes back by itself.
  void pump() noexcept {
    try {
      if (writing_) return;
      if (const auto message = queue_.next()) send(*message);
    } catch (const std::exception& error) {
      if (state_.closures.record(node::monotonic_nsec()))
        spdlog::warn("closed the connection to a page: {}", error.what());
      leave();
    }
  }

 private:
  void send(const SendQueue::Message& message) {
    writing_ = true;
    stream_.binary(!message.is_text);
    stream_.async_write(message.parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
      self->writing_ = false;
      if (error) return self->leave();
      self->pump();
    });
  }

  void read() {
    stream_.async_read(incoming_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->leave();
      self->on_message();
      self->read();
    });
  }

  void on_message() {
    const std::string text = beast::buffers_to_string(incoming_.data());
    incoming_.consume(incoming_.size());
    const auto word = read_acknowledgement(text);
    if (!word) {
      if (may_command_) {
        if (const auto command = read_page_command(text)) state_.execute(*command);
        if (const auto dragged = read_drag_request(text)) drag(*dragged);
      }
      if (const auto listens = read_sound_request(text)) queue_.listen(*listens);
      return;
    }
    const auto taken_nsec = queue_.credit().acknowledge(word->sequence);
    if (taken_nsec && word->drawn) {
      const std::lock_guard lock(state_.latency_mutex);
      state_.latency.record(node::monotonic_nsec() - *taken_nsec);
    }
    pump();
  }

  void drag(const DragRequest& request) {
    drags_ = true;
    const auto frame = state_.mirror.frame();
    static const std::vector<float> kNone;
    state_.pointers.drag(page_, request, frame ? frame->frame.position_m() : kNone,
                         node::monotonic_nsec());
  }

  void leave() {
    if (std::exchange(drags_, false)) state_.pointers.leave(page_, node::monotonic_nsec());
    state_.clients.erase(this);
    beast::get_lowest_layer(stream_).close();
  }

  websocket::stream<beast::tcp_stream> stream_;
  ConnectionSlot slot_;
  ServerState& state_;
  std::uint32_t page_;  // its number
  bool may_command_;
  bool drags_ = false;  // it has
  SendQueue queue_;
  beast::flat_buffer incoming_;
  bool joined_ = false;
  bool writing_ = false;
};

}  // namespace cordis::viz
