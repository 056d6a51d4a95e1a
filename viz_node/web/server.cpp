// viz_node/web/server.cpp -- listens, wakes the clients, reports the figures. The only source that
// knows Boost.Beast.
#include "viz_node/web/server.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <spdlog/spdlog.h>

#include "node/time.h"
#include "viz_node/foxglove_messages.h"
#include "viz_node/page_text.h"
#include "viz_node/web/http_session.h"
#include "viz_node/web/own_names.h"

namespace cordis::viz {
namespace {

constexpr auto kStatusPeriod = std::chrono::milliseconds(250);
constexpr auto kAcceptPause = std::chrono::milliseconds(100);
constexpr int kNextPorts = 20;  // tried after an occupied one

/// True if another port of the same address may do.
bool is_about_the_port(const ErrorCode& error) {
  return error == asio::error::address_in_use || error == asio::error::access_denied;
}

/// Listens at `endpoint`, or gives back why not and leaves `acceptor` closed.
ErrorCode try_to_listen(tcp::acceptor& acceptor, const tcp::endpoint& endpoint) {
  try {
    acceptor.open(endpoint.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    return {};
  } catch (const boost::system::system_error& error) {
    ErrorCode none;
    acceptor.close(none);
    return error.code();
  }
}

/// Listens at the port of `config`; at one of the next when it is occupied; at any free one when
/// those are occupied too. A page must not end a session.
/// @throws std::runtime_error when the address is not to be had
void listen(tcp::acceptor& acceptor, const ServerConfig& config) {
  const auto address = asio::ip::make_address(config.address);
  const auto wanted = static_cast<std::uint16_t>(config.port);
  const int last = wanted == 0 ? 0 : std::min(config.port + kNextPorts, 65535);
  ErrorCode error;
  for (int port = wanted; port <= last; ++port) {
    error = try_to_listen(acceptor, {address, static_cast<std::uint16_t>(port)});
    if (!is_about_the_port(error)) break;
  }
  if (is_about_the_port(error)) error = try_to_listen(acceptor, {address, 0});
  if (error) {
    throw std::runtime_error("cannot listen on " + config.address + " port " +
                             std::to_string(wanted) + ": " + error.message());
  }
  const std::uint16_t taken = acceptor.local_endpoint().port();
  if (wanted == 0 || taken == wanted) return;
  spdlog::warn(
      "port {} on {} is occupied by another program: the page is at port {}; {}.port=N "
      "chooses another one",
      wanted, config.address, taken, config.node);
}

/// The address of the page: the host name stands for "all addresses of this machine".
std::string url_of(const tcp::endpoint& endpoint) {
  const asio::ip::address address = endpoint.address();
  std::string host = address.to_string();
  if (address.is_v6()) host = "[" + host + "]";
  if (address.is_unspecified()) host = own_host_name();
  return "http://" + host + ":" + std::to_string(endpoint.port());
}

}  // namespace

struct WebServer::Impl {
  Impl(const ServerConfig& config, SceneMirror& mirror, PointerServer& pointers,
       std::function<void(const PageCommand&)> execute)
      : pages(config.folder), state(mirror, pointers, std::move(execute)) {
    listen(acceptor, config);
    const tcp::endpoint endpoint = acceptor.local_endpoint();
    url = url_of(endpoint);
    state.hello = hello_text(config.session, config.node, config.rights, true);
    state.hello_view_only = hello_text(config.session, config.node, config.rights, false);
    if (!endpoint.address().is_loopback()) open_to_others(config.token);
    state.is_view_only = config.is_view_only;
    state.topics = config.topics;
    state.hosts.foxglove = config.topics != nullptr;
    state.server_info = server_info_text(config.session, config.epoch);
  }

  void open_to_others(const std::string& token) {
    if (!is_usable_token(token))
      throw std::runtime_error("the token of the page needs " + std::to_string(kShortestToken) +
                               " letters, digits, '-' or '_'");
    state.hosts = {.loopback_only = false, .names = own_names()};
    state.token = token;
  }

  void accept() {
    acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // out of file descriptors, most likely: later there may be some
        pause.expires_after(kAcceptPause);
        return pause.async_wait([this](ErrorCode) { accept(); });
      }
      accept();        // first: whatever becomes of this one, others may come
      ErrorCode none;  // a socket that takes no option still works
      socket.set_option(tcp::no_delay(true), none);
      serve(std::move(socket), state, pages);
    });
  }

  /// One that cannot go on leaves the set meanwhile.
  template <class Session>
  static void pump(const std::unordered_set<Session*>& sessions) {
    const std::vector<Session*> now(sessions.begin(), sessions.end());
    for (Session* session : now) session->pump();
  }

  /// Also pumps clients whose frames were not acknowledged in time.
  void report_status() {
    tick.expires_after(kStatusPeriod);
    tick.async_wait([this](ErrorCode error) {
      if (!error) report_status();
    });
    state.status = std::make_shared<const std::string>(state.mirror.status(node::monotonic_nsec()));
    ++state.status_number;
    state.closures.report(node::monotonic_nsec());
    pump(state.clients);
    pump(state.foxglove_clients);
  }

  /// Any thread: something new is in the mirror. At most one call waits at a time.
  void wake() {
    if (awake.exchange(true)) return;
    asio::post(context, [this] {
      awake = false;
      pump(state.clients);
    });
  }

  /// Any thread: something new is in the topics. Apart from wake(), for it may come with each message
  /// of a force loop.
  void wake_foxglove() {
    if (foxglove_awake.exchange(true)) return;
    asio::post(context, [this] {
      foxglove_awake = false;
      pump(state.foxglove_clients);
    });
  }

  /// An error ends the connection that it concerns, not the server.
  void run() noexcept {
    while (!context.stopped()) {
      try {
        context.run();
      } catch (const std::exception& error) {
        if (state.closures.record(node::monotonic_nsec()))
          spdlog::error("the web server closed a connection: {}", error.what());
      }
    }
  }

  StaticPages pages;
  ServerState state;
  std::string url;
  std::atomic<bool> awake{false};
  std::atomic<bool> foxglove_awake{false};
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  asio::steady_timer tick{context};
  asio::steady_timer pause{context};
  std::thread thread;
};

WebServer::WebServer(const ServerConfig& config, SceneMirror& mirror, PointerServer& pointers,
                     std::function<void(const PageCommand&)> execute)
    : impl_(std::make_unique<Impl>(config, mirror, pointers, std::move(execute))) {
  mirror.on_change([impl = impl_.get()] { impl->wake(); });
  pointers.on_change([impl = impl_.get()] { impl->wake(); });
  if (config.topics != nullptr)
    config.topics->on_change([impl = impl_.get()] { impl->wake_foxglove(); });
  impl_->accept();
  impl_->report_status();
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

WebServer::~WebServer() {
  impl_->state.mirror.on_change({});
  impl_->state.pointers.on_change({});
  if (impl_->state.topics != nullptr) impl_->state.topics->on_change({});
  impl_->context.stop();
  impl_->thread.join();
}

const std::string& WebServer::url() const noexcept {
  return impl_->url;
}

std::string WebServer::command_url() const {
  if (impl_->state.token.empty()) return impl_->url;
  return impl_->url + "/?token=" + impl_->state.token;
}

bool WebServer::page_built() const noexcept {
  return impl_->pages.built();
}

ServerFigures WebServer::figures() const {
  const std::lock_guard lock(impl_->state.latency_mutex);
  const node::LatencyHistogram& latency = impl_->state.latency;
  return {.drawn = latency.count(),
          .latency_p50_s = latency.quantile_nsec(0.5) * 1e-9,
          .latency_p99_s = latency.quantile_nsec(0.99) * 1e-9,
          .latency_max_s = static_cast<double>(latency.largest_nsec()) * 1e-9};
}

}  // namespace cordis::viz
