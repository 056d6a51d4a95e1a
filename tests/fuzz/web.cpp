// tests/fuzz/web.cpp -- what a browser, or a stranger, may send to the page's server.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "viz_node/web/http_session.h"

namespace cordis::fuzz {
namespace {

using namespace viz;

/// Requests of a page and of Foxglove.
constexpr std::string_view kUpgrade =
    "GET /live HTTP/1.1\r\nHost: localhost:8080\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

constexpr std::string_view kFoxgloveUpgrade =
    "GET / HTTP/1.1\r\nHost: localhost:8080\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n";

/// A folder without a page.
StaticPages no_pages() {
  return StaticPages(std::filesystem::path("/nonexistent"));
}

/// The server without its port: one connection after the other, over a pair of sockets.
class Server {
 public:
  Server() {
    state_.status = std::make_shared<const std::string>("{}");
    state_.topics = &topics_;
    state_.hosts.foxglove = true;
    state_.server_info = "{}";
    topics_.set_writers({{.id = {1}, .topic = signals_, .partitions = {}},
                         {.id = {2}, .topic = device_, .partitions = {}}},
                        {});
  }

  /// Plays a connection: all of its bytes, then its end.
  void play(const std::vector<std::string>& parts) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) std::abort();
    {
      tcp::socket socket(context_);
      socket.assign(tcp::v4(), ends[0]);
      serve(std::move(socket), state_, pages_);
    }
    for (const std::string& part : parts) {
      run();
      static_cast<void>(::send(ends[1], part.data(), part.size(), MSG_NOSIGNAL));
      run();
      say(signals_, 1);
      say(device_, 2);
      for (FoxgloveSession* client : state_.foxglove_clients) client->pump();
      discard(ends[1]);
    }
    ::shutdown(ends[1], SHUT_WR);
    for (int round = 0; round < 4; ++round) {
      run();
      discard(ends[1]);
    }
    ::close(ends[1]);
    run();
    if (state_.connections != 0 || !state_.clients.empty() || !state_.foxglove_clients.empty())
      std::abort();
    if (topics_.is_wanted(signals_) || topics_.is_wanted(device_)) std::abort();
  }

 private:
  void run() {
    context_.restart();
    context_.poll();
  }

  void say(const dds::RawTopic& topic, std::uint8_t writer) {
    const std::array<std::uint8_t, 12> bytes{0, 1, 0, 0, writer};
    topics_.add(topic, {.data = bytes.data(), .size = bytes.size(), .writer = {writer}});
  }

  static void discard(int socket) {
    std::array<char, 16384> bytes;
    while (::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
  }

  const dds::RawTopic signals_{.name = "scene/signals", .type = "cordis::msg::SceneSignals"};
  const dds::RawTopic device_{.name = "device/description",
                              .type = "cordis::msg::DeviceDescription",
                              .keyed = true,
                              .transient_local = true};
  TopicBoard topics_;
  asio::io_context context_{1};
  SceneMirror mirror_{25.0};
  PointerServer pointers_{1, [](msg::PointerTarget&) {}};
  ServerState state_{mirror_, pointers_, [](const PageCommand&) {}};
  StaticPages pages_ = no_pages();
};

/// A frame of text, masked with zeros.
std::string frame_of(std::string_view text) {
  std::string frame = "\x81";
  if (text.size() < 126) {
    frame += static_cast<char>(0x80 | text.size());
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size() & 0xff);
  }
  return frame.append(4, '\0').append(text);
}

}  // namespace
}  // namespace cordis::fuzz

/// The first byte says what follows: 'h' bytes of HTTP, 'w' bytes of a WebSocket, 't' texts of one,
/// each on a line of its own. 'f' are texts of Foxglove, and 'b' are bytes of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cordis::fuzz;
  constexpr std::size_t kLongest = 16384;
  if (size == 0 || size > kLongest) return 0;
  static Server server;
  std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::vector<std::string> parts;
  if (data[0] == 'w' || data[0] == 't') parts.emplace_back(kUpgrade);
  if (data[0] == 'f' || data[0] == 'b') parts.emplace_back(kFoxgloveUpgrade);
  if (data[0] != 't' && data[0] != 'f') {
    parts.emplace_back(rest);
    server.play(parts);
    return 0;
  }
  while (!rest.empty() && parts.size() < 100) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    parts.push_back(frame_of(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  server.play(parts);
  return 0;
}
