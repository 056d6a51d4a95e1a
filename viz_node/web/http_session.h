// viz_node/web/http_session.h -- what a browser asks for by HTTP.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/buffer.hpp>

#include "viz_node/web/foxglove_session.h"
#include "viz_node/web/request_filter.h"
#include "viz_node/web/static_pages.h"
#include "viz_node/web/websocket_session.h"

namespace cordis::viz {

inline constexpr std::size_t kLongestRequest = 8192;  // [bytes]
inline constexpr std::size_t kLongestBody = 8192;     // of a request, which is passed over [bytes]

inline constexpr const char* kPlainText = "text/plain; charset=utf-8";
inline constexpr const char* kContentPolicy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "frame-ancestors 'none'";

/// One HTTP connection, until it ends or becomes a WebSocketSession or a
/// FoxgloveSession.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket&& socket, ServerState& state, const StaticPages& pages)
      : stream_(std::move(socket)), slot_(state), state_(state), pages_(pages) {
    state_.requests.emplace(place_, this);
  }
  ~HttpSession() { state_.requests.erase(place_); }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void read() {
    set_busy(false);
    parser_.emplace();
    parser_->header_limit(kLongestRequest);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read; 1.74 refuses
                                                                     // all with "no limit"
    stream_.expires_after(kRequestTimeout);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](ErrorCode error, std::size_t) {
                              if (error) return;
                              self->set_busy(true);
                              self->answer();
                            });
  }

  /// Makes room for another connection.
  void close() {
    state_.requests.erase(place_);
    stream_.close();
  }

 private:
  void set_busy(bool busy) {
    if (state_.requests.erase(place_) == 0) return;  // closed meanwhile
    place_ = {busy, ++state_.request_count};
    state_.requests.emplace(place_, this);
  }

  /// Passes over the body of a request, so that the next one begins behind it.
  void skip_body() {
    if (parser_->content_length().value_or(0) > kLongestBody ||
        parser_->get().body().size() > kLongestBody)
      return reply(413, kPlainText, "the body of a request is too long\n");
    http::async_read_some(stream_, buffer_, *parser_,
                          [self = shared_from_this()](ErrorCode error, std::size_t) {
                            if (!error) self->answer();
                          });
  }

  void answer() {
    const auto& request = parser_->get();
    const auto field = [&request](http::field name) {
      const auto value = request[name];
      return std::string_view(value.data(), value.size());
    };
    const bool upgrade = websocket::is_upgrade(request);
    const std::string_view target(request.target().data(), request.target().size());
    const std::string_view method(request.method_string().data(), request.method_string().size());
    const std::string_view protocols = field(http::field::sec_websocket_protocol);
    const auto refusal = refusal_of({.method = method,
                                     .target = target,
                                     .host = field(http::field::host),
                                     .origin = field(http::field::origin),
                                     .upgrade = upgrade,
                                     .protocols = protocols},
                                    state_.hosts);
    if (refusal) return reply(refusal->status, kPlainText, refusal->text);
    if (!parser_->is_done()) {
      if (upgrade) return reply(400, kPlainText, "a WebSocket begins without a body\n");
      return skip_body();
    }
    if (upgrade) {
      if (state_.pages() >= kMaxPages) return reply(503, kPlainText, "too many pages are open\n");
      state_.requests.erase(place_);
      const http::request<http::empty_body> first(request.base());
      const std::string_view protocol = foxglove_protocol_of(protocols);
      if (!protocol.empty()) {
        std::make_shared<FoxgloveSession>(std::move(stream_), std::move(slot_), state_)
            ->start(first, std::string(protocol));
        return;
      }
      std::make_shared<WebSocketSession>(std::move(stream_), std::move(slot_), state_,
                                         state_.may_command(target), every_of(target))
          ->start(first);
      return;
    }
    const StaticPage* page = pages_.find(path_of(target), field(http::field::accept_encoding));
    if (page == nullptr) return reply(404, kPlainText, "there is no such page\n");
    reply(200, page->type, page->content, page->encoding);
  }

  void reply(unsigned status, const std::string& type, const std::string& content,
             const std::string& encoding = {}) {
    response_ = {};
    if (!encoding.empty()) response_.set(http::field::content_encoding, encoding);
    response_.set(http::field::vary, "Accept-Encoding");
    response_.result(status);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");  // the address may hold the token
    response_.set("Content-Security-Policy", kContentPolicy);
    if (status == 405) response_.set(http::field::allow, "GET, HEAD");
    response_.body() = content;
    response_.prepare_payload();
    // HEAD: the fields of the answer to GET, and nothing behind them.
    if (parser_->get().method() == http::verb::head) response_.body().clear();
    response_.keep_alive(status == 200 && parser_->get().keep_alive());
    stream_.expires_after(kReplyTimeout);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](ErrorCode error, std::size_t) {
                        if (error) return;
                        if (self->response_.keep_alive()) return self->read();
                        ErrorCode none;  // the other end may be gone already
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, none);
                        self->stream_.expires_after(kRequestTimeout);
                        self->drain();
                      });
  }

  /// Reads on until the other end closes: closing on a body not yet read would take the answer
  /// back.
  void drain() {
    stream_.async_read_some(asio::buffer(discarded_),
                            [self = shared_from_this()](ErrorCode error, std::size_t) {
                              if (!error) self->drain();
                            });
  }

  beast::tcp_stream stream_;
  ConnectionSlot slot_;
  ServerState& state_;
  const StaticPages& pages_;
  std::pair<bool, std::uint64_t> place_{false, ++state_.request_count};  // in state_.requests
  beast::flat_buffer buffer_{kLongestRequest};
  std::array<char, 1024> discarded_{};
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
};

/// Serves a connection. Beyond kMaxRequests the one that has waited longest for a request goes, or
/// else the one that has been answered longest: no one who is slow shuts out a newcomer.
inline void serve(tcp::socket&& socket, ServerState& state, const StaticPages& pages) {
  if (state.requests.size() >= kMaxRequests) state.requests.begin()->second->close();
  std::make_shared<HttpSession>(std::move(socket), state, pages)->read();
}

}  // namespace cordis::viz
