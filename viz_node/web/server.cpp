// viz_node/web/server.cpp -- the only file that knows Boost.Beast: it takes half a minute to
// compile.
#include "viz_node/web/server.h"

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <spdlog/spdlog.h>

#include "node/latency.h"
#include "node/stop.h"
#include "node/time.h"
#include "viz_node/frame_encoder.h"
#include "viz_node/web/client_credit.h"
#include "viz_node/web/gate.h"
#include "viz_node/web/static_pages.h"

namespace cordis::viz {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr auto kRequestTimeout = std::chrono::seconds(10);
constexpr auto kSilenceTimeout = std::chrono::seconds(30);
constexpr auto kStatusPeriod = std::chrono::milliseconds(250);
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
constexpr std::size_t kMostConnections = 64;
constexpr std::size_t kLongestRequest = 8192;     // [bytes]
constexpr std::size_t kLongestFromClient = 1024;  // [bytes]

constexpr const char* kContentPolicy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "frame-ancestors 'none'";

class Client;

/// What all connections share. Lives in the server's thread, but for the latency.
struct Hub {
  Hub(SceneMirror& of, std::function<void(const PageCommand&)> call)
      : mirror(of), obey(std::move(call)) {}

  SceneMirror& mirror;
  std::function<void(const PageCommand&)> obey;
  std::string hello;
  std::shared_ptr<const std::string> status;  // newest text
  std::uint64_t status_number = 0;
  bool loopback_only = true;
  std::size_t connections = 0;
  std::unordered_set<Client*> clients;
  mutable std::mutex latency_mutex;
  node::LatencyHistogram latency;
};

/// Counts a connection for as long as it lives, as HTTP or as WebSocket.
class Seat {
 public:
  explicit Seat(Hub& hub) noexcept : hub_(&hub) { ++hub_->connections; }
  Seat(Seat&& other) noexcept : hub_(std::exchange(other.hub_, nullptr)) {}
  Seat& operator=(Seat&&) = delete;
  ~Seat() {
    if (hub_ != nullptr) --hub_->connections;
  }

 private:
  Hub* hub_;
};

/// One page. Sends one message at a time, whatever is most due; reads acknowledgements and
/// commands.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(beast::tcp_stream&& stream, Seat&& seat, Hub& hub)
      : stream_(std::move(stream)), seat_(std::move(seat)), hub_(hub) {}
  ~Client() {
    hub_.clients.erase(this);
    if (joined_) spdlog::debug("a page left, {} frames passed it by", credit_.dropped());
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{kRequestTimeout, kSilenceTimeout,
                                                       /*keep_alive_pings=*/true});
    stream_.read_message_max(kLongestFromClient);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return;
      self->joined_ = true;
      self->hub_.clients.insert(self.get());
      self->read();
      self->pump();
    });
  }

  /// Sends the next thing that is due, unless a message is still on its way into the socket.
  void pump() {
    if (writing_) return;
    if (!hello_sent_) {
      hello_sent_ = true;
      return send_text(hub_.hello);
    }
    if (send_scene() || send_status() || send_signals()) return;
    send_frame();
  }

 private:
  bool send_scene() {
    if (topology_due_ != nullptr) {
      kept_scene_ = std::exchange(topology_due_, nullptr);
      send_binary({asio::buffer(kept_scene_->topology)});
      return true;
    }
    auto scene = hub_.mirror.scene();
    if (scene == nullptr || scene->scene == scene_) return false;
    scene_ = scene->scene;
    kept_scene_ = topology_due_ = std::move(scene);
    send_text(kept_scene_->text);
    return true;
  }

  bool send_status() {
    if (hub_.status == nullptr || status_number_ == hub_.status_number) return false;
    status_number_ = hub_.status_number;
    kept_status_ = hub_.status;
    send_text(*kept_status_);
    return true;
  }

  bool send_signals() {
    kept_signals_ = hub_.mirror.signals_after(signals_number_);
    if (kept_signals_ == nullptr) return false;
    signals_number_ = kept_signals_->number;
    send_binary({asio::buffer(kept_signals_->bytes)});
    return true;
  }

  void send_frame() {
    kept_frame_ = hub_.mirror.frame();
    if (kept_frame_ == nullptr || kept_frame_->scene != scene_) return;
    if (!credit_.may_send(kept_frame_->sequence)) return;
    const msg::SceneFrame& frame = kept_frame_->frame;
    const bool played = frame.action_time_nsec() != 0;
    credit_.sent(kept_frame_->sequence, played ? frame.action_time_nsec() : frame.time_nsec());
    header_ = encode({.sequence = kept_frame_->sequence,
                      .scene = kept_frame_->scene,
                      .frame = frame.frame(),
                      .step = frame.step(),
                      .taken_nsec = frame.time_nsec(),
                      .sent_nsec = node::monotonic_nsec(),
                      .simulated_s = frame.simulated_s(),
                      .mat_count = static_cast<std::uint32_t>(frame.position_m().size() / 3),
                      .link_state_count = static_cast<std::uint32_t>(frame.link_state().size()),
                      .dropped = credit_.dropped()});
    send_binary({asio::buffer(header_), asio::buffer(frame.position_m()),
                 asio::buffer(frame.link_state())});
  }

  void send_text(const std::string& text) {
    stream_.text(true);
    send({asio::buffer(text)});
  }

  void send_binary(const std::array<asio::const_buffer, 3>& parts) {
    stream_.binary(true);
    send(parts);
  }

  void send(const std::array<asio::const_buffer, 3>& parts) {
    writing_ = true;
    stream_.async_write(parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
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
      if (const auto command = read_page_command(text)) hub_.obey(*command);
      return;
    }
    const auto taken_nsec = credit_.acknowledge(word->sequence);
    if (taken_nsec && word->drawn) {
      const std::lock_guard lock(hub_.latency_mutex);
      hub_.latency.record(node::monotonic_nsec() - *taken_nsec);
    }
    pump();
  }

  void leave() {
    hub_.clients.erase(this);
    beast::get_lowest_layer(stream_).close();
  }

  websocket::stream<beast::tcp_stream> stream_;
  Seat seat_;
  Hub& hub_;
  ClientCredit credit_;
  beast::flat_buffer incoming_;
  bool joined_ = false;
  bool writing_ = false;
  bool hello_sent_ = false;
  std::uint32_t scene_ = 0;
  std::uint64_t status_number_ = 0;
  std::uint64_t signals_number_ = 0;
  std::shared_ptr<const ShownScene> topology_due_;
  // What the message on its way is made of.
  std::shared_ptr<const ShownScene> kept_scene_;
  std::shared_ptr<const std::string> kept_status_;
  std::shared_ptr<const ShownSignals> kept_signals_;
  std::shared_ptr<const ShownFrame> kept_frame_;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
};

/// One HTTP connection, until it ends or becomes a Client.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(tcp::socket&& socket, Hub& hub, const StaticPages& pages)
      : stream_(std::move(socket)), seat_(hub), hub_(hub), pages_(pages) {}

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
                                    hub_.loopback_only);
    if (refusal) return reply(refusal->status, "text/plain; charset=utf-8", refusal->text);
    if (upgrade) {
      std::make_shared<Client>(std::move(stream_), std::move(seat_), hub_)
          ->start(http::request<http::empty_body>(request));
      return;
    }
    const StaticPage* page = pages_.find(path_of(target));
    if (page == nullptr) return reply(404, "text/plain; charset=utf-8", "there is no such page\n");
    reply(200, page->type, page->content);
  }

  void reply(unsigned status, const std::string& type, const std::string& content) {
    response_ = {};
    response_.result(status);
    response_.set(http::field::content_type, type);
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Content-Security-Policy", kContentPolicy);
    if (status == 405) response_.set(http::field::allow, "GET");
    response_.body() = content;
    response_.prepare_payload();
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
  Seat seat_;
  Hub& hub_;
  const StaticPages& pages_;
  beast::flat_buffer buffer_{kLongestRequest};
  std::array<char, 1024> discarded_{};
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
};

/// Listens, or says what to do when that cannot be.
void listen(tcp::acceptor& acceptor, const ServerConfig& config) {
  const tcp::endpoint endpoint(asio::ip::make_address(config.address),
                               static_cast<std::uint16_t>(config.port));
  try {
    acceptor.open(endpoint.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
  } catch (const boost::system::system_error& error) {
    const std::string port = std::to_string(config.port);
    if (error.code() == asio::error::address_in_use) {
      throw std::runtime_error("port " + port + " on " + config.address +
                               " is occupied by another program; choose another one: " +
                               config.node + ".port=" + std::to_string(config.port % 65535 + 1));
    }
    throw std::runtime_error("cannot listen on " + config.address + " port " + port + ": " +
                             error.code().message());
  }
}

std::string url_of(const tcp::endpoint& endpoint) {
  const std::string address = endpoint.address().to_string();
  return "http://" + (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" +
         std::to_string(endpoint.port());
}

}  // namespace

struct WebServer::Impl {
  Impl(const ServerConfig& config, SceneMirror& mirror,
       std::function<void(const PageCommand&)> obey)
      : pages(config.folder), hub(mirror, std::move(obey)) {
    listen(acceptor, config);
    const tcp::endpoint endpoint = acceptor.local_endpoint();
    url = url_of(endpoint);
    hub.loopback_only = endpoint.address().is_loopback();
    hub.hello = hello_text(config.session, config.node);
  }

  void accept() {
    acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // out of file descriptors, most likely: later there may be some
        pause.expires_after(kAcceptPause);
        return pause.async_wait([this](ErrorCode) { accept(); });
      }
      ErrorCode none;  // a socket that takes no option still works
      socket.set_option(tcp::no_delay(true), none);
      if (hub.connections < kMostConnections)
        std::make_shared<Visitor>(std::move(socket), hub, pages)->read();
      accept();
    });
  }

  void pump_all() {
    const std::vector<Client*> now(hub.clients.begin(), hub.clients.end());
    for (Client* client : now) client->pump();
  }

  void tell_status() {
    hub.status = std::make_shared<const std::string>(hub.mirror.status(node::monotonic_nsec()));
    ++hub.status_number;
    pump_all();
    tick.expires_after(kStatusPeriod);
    tick.async_wait([this](ErrorCode error) {
      if (!error) tell_status();
    });
  }

  /// Any thread: something new is in the mirror. At most one call waits at a time.
  void wake() {
    if (awake.exchange(true)) return;
    asio::post(context, [this] {
      awake = false;
      pump_all();
    });
  }

  void run() {
    try {
      context.run();
    } catch (const std::exception& error) {
      spdlog::error("the web server failed: {}", error.what());
      node::request_stop();
    }
  }

  StaticPages pages;
  Hub hub;
  std::string url;
  std::atomic<bool> awake{false};
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  asio::steady_timer tick{context};
  asio::steady_timer pause{context};
  std::thread thread;
};

WebServer::WebServer(const ServerConfig& config, SceneMirror& mirror,
                     std::function<void(const PageCommand&)> obey)
    : impl_(std::make_unique<Impl>(config, mirror, std::move(obey))) {
  mirror.on_change([impl = impl_.get()] { impl->wake(); });
  impl_->accept();
  impl_->tell_status();
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

WebServer::~WebServer() {
  impl_->hub.mirror.on_change({});
  impl_->context.stop();
  impl_->thread.join();
}

const std::string& WebServer::url() const noexcept {
  return impl_->url;
}

bool WebServer::page_built() const noexcept {
  return impl_->pages.built();
}

ServerFigures WebServer::figures() const {
  const std::lock_guard lock(impl_->hub.latency_mutex);
  const node::LatencyHistogram& latency = impl_->hub.latency;
  return {.drawn = latency.count(),
          .latency_p50_s = latency.quantile_nsec(0.5) * 1e-9,
          .latency_p99_s = latency.quantile_nsec(0.99) * 1e-9,
          .latency_max_s = static_cast<double>(latency.largest_nsec()) * 1e-9};
}

}  // namespace cordis::viz
