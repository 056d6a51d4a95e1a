// tests/viz/http_session_test.cpp -- connections to the page's server over pairs of sockets.
#include "viz_node/web/http_session.h"

#include <array>
#include <cerrno>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cordis::viz {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

/// The other end of a connection.
class Browser {
 public:
  explicit Browser(int socket) : socket_(socket) {}
  Browser(Browser&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), answer_(std::move(other.answer_)) {}
  Browser& operator=(Browser&&) = delete;
  ~Browser() {
    if (socket_ >= 0) ::close(socket_);
  }

  void say(std::string_view bytes) const {
    static_cast<void>(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  }

  /// Says no more.
  void end() const { ::shutdown(socket_, SHUT_WR); }

  /// Takes what has come since the last call.
  std::string take() {
    std::array<char, 4096> bytes;
    std::string taken;
    for (;;) {
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (count == 0 || (count < 0 && errno != EAGAIN)) closed_ = true;
      if (count <= 0) return taken;
      taken.append(bytes.data(), static_cast<std::size_t>(count));
    }
  }

  bool closed() {
    answer_ += take();
    return closed_;
  }

 private:
  int socket_;
  bool closed_ = false;
  std::string answer_;
};

/// The server without its port and its thread.
class Server {
 public:
  Server() {
    state_.hello = "may command";
    state_.hello_view_only = "view only";
    state_.status = std::make_shared<const std::string>("{}");
  }

  Browser connect() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends), 0);
    tcp::socket socket(context_);
    socket.assign(tcp::v4(), ends[0]);
    std::make_shared<HttpSession>(std::move(socket), state_, pages_)->read();
    run();
    return Browser(ends[1]);
  }

  /// Does all that can be done now.
  void run() {
    context_.restart();
    context_.poll();
  }

  ServerState& state() noexcept { return state_; }
  const std::vector<PageCommand>& commands() const noexcept { return commands_; }

 private:
  std::vector<PageCommand> commands_;
  SceneMirror mirror_{25.0};
  PointerDesk pointers_{1, [](msg::PointerTarget&) {}};
  ServerState state_{mirror_, pointers_,
                     [this](const PageCommand& command) { commands_.push_back(command); }};
  StaticPages pages_{std::filesystem::path("/nonexistent")};
  asio::io_context context_{1};
};

/// What a browser gets for a request.
std::string reply_to(Server& server, const std::string& request) {
  Browser browser = server.connect();
  browser.say(request);
  server.run();
  return browser.take();
}

std::string upgrade_of(const std::string& target) {
  return "GET " + target +
         " HTTP/1.1\r\nHost: localhost:8080\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

/// A text of a page, masked with zeros.
std::string frame_of(const std::string& text) {
  return std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(4, '\0') + text;
}

/// True if the hello of a page with this target says that it may command, and its command counts.
bool may_command(Server& server, const std::string& target) {
  const std::size_t before = server.commands().size();
  Browser page = server.connect();
  page.say(upgrade_of(target));
  server.run();
  const std::string hello = page.take();
  EXPECT_TRUE(hello.starts_with("HTTP/1.1 101")) << hello;
  page.say(frame_of(R"({"type": "command", "verb": "pause"})"));
  server.run();
  const bool counted = server.commands().size() > before;
  EXPECT_EQ(hello.find("may command") != std::string::npos, counted);
  EXPECT_EQ(hello.find("view only") == std::string::npos, counted);
  return counted;
}

TEST(HttpSession, EveryPageOfThisMachineMayCommand) {
  Server server;

  EXPECT_TRUE(may_command(server, "/live"));
}

TEST(HttpSession, OnlyAPageWithTheTokenMayCommandBeyondLoopback) {
  Server server;
  server.state().token = kToken;

  EXPECT_TRUE(may_command(server, "/live?token=" + kToken));
  EXPECT_TRUE(may_command(server, "/live?x=y&token=" + kToken));
  for (const std::string& target :
       {std::string("/live"), std::string("/live?token="), "/live?token=" + kToken + "0",
        "/live?token=" + kToken.substr(1), "/live?token=x" + kToken.substr(1)})
    EXPECT_FALSE(may_command(server, target)) << target;
}

TEST(HttpSession, AnswersAPageWithoutTheTokenToo) {
  Server server;
  server.state().token = kToken;

  EXPECT_TRUE(
      reply_to(server, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").starts_with("HTTP/1.1 200"));
}

TEST(HttpSession, TellsNoOtherSiteTheAddressOfThePage) {
  Server server;

  EXPECT_NE(reply_to(server, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
                .find("Referrer-Policy: no-referrer"),
            std::string::npos);
}

}  // namespace
}  // namespace cordis::viz
