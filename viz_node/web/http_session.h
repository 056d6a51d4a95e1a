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

#include "viz_node/web/request_filter.h"
#include "viz_node/web/static_pages.h"
#include "viz_node/web/websocket_session.h"

namespace cordis::viz {

inline constexpr std::size_t kLongestRequest = 8192;  // [bytes]

inline constexpr const char* kContentPolicy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "frame-ancestors 'none'";

/// One HTTP connection, until it ends or becomes a WebSocketSession.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket&& socket, ServerState& state, const StaticPages& pages)
      : stream_(std::move(socket)), slot_(state), state_(state), pages_(pages) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kLongestRequest);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read; 1.74 refuses
                                                                     // all with "no limit"
    stream_.expires_after(kRequestTimeout);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](ErrorCode error, std::size_t) {
                              if (!error) self->answer();
                            });
  }

 private:
  void answer() {
    const auto& request = parser_->get();
    const auto field = [&request](http::field name) {
      const auto value = request[name];
      return std::string_view(value.data(), value.size());
    };
    const bool upgrade = websocket::is_upgrade(request);
    const std::string_view target(request.target().data(), request.target().size());
    const std::string_view method(request.method_string().data(), request.method_string().size());
    const auto refusal = refusal_of({.method = method,
                                     .target = target,
                                     .host = field(http::field::host),
                                     .origin = field(http::field::origin),
                                     .upgrade = upgrade},
                                    state_.hosts);
    if (refusal) return reply(refusal->status, "text/plain; charset=utf-8", refusal->text);
    if (upgrade) {
      std::make_shared<WebSocketSession>(std::move(stream_), std::move(slot_), state_,
                                         state_.may_command(target))
          ->start(http::request<http::empty_body>(request));
      return;
    }
    const StaticPage* page = pages_.find(path_of(target), field(http::field::accept_encoding));
    if (page == nullptr) return reply(404, "text/plain; charset=utf-8", "there is no such page\n");
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
    http::async_write(stream_, response_,
                      [self = shared_from_this()](ErrorCode error, std::size_t) {
                        if (error) return;
                        if (self->response_.keep_alive()) return self->read();
                        ErrorCode none;  // the other end may be gone already
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, none);
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
  beast::flat_buffer buffer_{kLongestRequest};
  std::array<char, 1024> discarded_{};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

}  // namespace cordis::viz
