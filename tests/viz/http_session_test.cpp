// tests/viz/http_session_test.cpp -- connections to the page's server over pairs of sockets.
#include "viz_node/web/http_session.h"

#include <array>
#include <cerrno>
#include <memory>
#include <random>
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
    serve(std::move(socket), state_, pages_);
    run();
    return Browser(ends[1]);
  }

  /// Does all that can be done now.
  void run() {
    context_.restart();
    context_.poll();
  }

  ServerState& state() noexcept { return state_; }

  /// Foxglove may read from now on.
  TopicBoard& open_to_foxglove() {
    state_.topics = &topics_;
    state_.hosts.foxglove = true;
    state_.server_info = "greeting of Foxglove";
    return topics_;
  }
  const std::vector<PageCommand>& commands() const noexcept { return commands_; }

 private:
  std::vector<PageCommand> commands_;
  SceneMirror mirror_{25.0};
  TopicBoard topics_;
  PointerServer pointers_{1, [](msg::PointerTarget&) {}};
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

/// @param fields  more of them, each with its end of line
std::string upgrade_of(const std::string& target, const std::string& fields = {}) {
  return "GET " + target +
         " HTTP/1.1\r\nHost: localhost:8080\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
         fields + "\r\n";
}

const std::string kFoxgloveFields =
    "Sec-WebSocket-Protocol: foxglove.sdk.v1, foxglove.websocket.v1\r\n"
    "Origin: https://app.foxglove.dev\r\n";

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

constexpr std::string_view kGet = "GET / HTTP/1.1\r\nHost: localhost\r\n";

std::size_t count_of(std::string_view text, std::string_view word) {
  std::size_t count = 0;
  for (std::size_t i = text.find(word); i != std::string_view::npos; i = text.find(word, i + 1))
    ++count;
  return count;
}

TEST(HttpSession, AnswersTheRequestBehindABody) {
  Server server;
  const std::string get(kGet);
  for (const std::string& first :
       {get + "Content-Length: 5\r\n\r\nhello", get + "Content-Length: 0\r\n\r\n",
        get + "Content-Length: 19\r\n\r\nGET /x HTTP/1.1\r\n\r\n",
        get + "Content-Length: 8192\r\n\r\n" + std::string(8192, 'x'),
        get + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n3\r\nyou\r\n0\r\n\r\n"}) {
    Browser browser = server.connect();
    browser.say(first);
    server.run();
    EXPECT_TRUE(browser.take().starts_with("HTTP/1.1 200")) << first.substr(0, 100);
    browser.say(get + "\r\n");
    server.run();
    EXPECT_TRUE(browser.take().starts_with("HTTP/1.1 200")) << "after " << first.substr(0, 100);
    EXPECT_FALSE(browser.closed());

    EXPECT_EQ(count_of(reply_to(server, first + get + "\r\n"), "HTTP/1.1 200"), 2u)
        << "at once: " << first.substr(0, 100);
  }
}

TEST(HttpSession, TakesABodyThatComesInPieces) {
  Server server;
  Browser browser = server.connect();
  browser.say(std::string(kGet) + "Content-Length: 5\r\n\r\nhe");
  server.run();
  EXPECT_EQ(browser.take(), "");

  browser.say("llo");
  server.run();

  EXPECT_TRUE(browser.take().starts_with("HTTP/1.1 200"));
}

TEST(HttpSession, RefusesABodyThatIsTooLong) {
  Server server;
  const std::string get(kGet);

  EXPECT_TRUE(reply_to(server, get + "Content-Length: 8193\r\n\r\n").starts_with("HTTP/1.1 413"));
  EXPECT_TRUE(reply_to(server, get + "Content-Length: 9223372036854775807\r\n\r\n")
                  .starts_with("HTTP/1.1 413"));
  EXPECT_TRUE(
      reply_to(server, get + "Transfer-Encoding: chunked\r\n\r\n4e20\r\n" + std::string(20000, 'x'))
          .starts_with("HTTP/1.1 413"));
}

TEST(HttpSession, ServesANewcomerBesideAnyNumberOfHalfOpenRequests) {
  Server server;
  std::vector<Browser> slow;
  for (int i = 0; i < 200; ++i) {
    slow.push_back(server.connect());
    slow.back().say(i % 2 == 0 ? "" : "GET / HTTP/1.1\r\nHo");
    server.run();
    ASSERT_LE(server.state().connections, kMaxRequests);
    ASSERT_TRUE(reply_to(server, std::string(kGet) + "\r\n").starts_with("HTTP/1.1 200")) << i;
    server.run();
  }
  EXPECT_TRUE(slow.front().closed());
  EXPECT_FALSE(slow.back().closed());
}

TEST(HttpSession, ServesANewcomerBesideAsManyPagesAsMayBe) {
  Server server;
  std::vector<Browser> pages;
  for (std::size_t i = 0; i < kMaxPages; ++i) {
    pages.push_back(server.connect());
    pages.back().say(upgrade_of("/live"));
    server.run();
    ASSERT_TRUE(pages.back().take().starts_with("HTTP/1.1 101")) << i;
  }

  EXPECT_TRUE(reply_to(server, upgrade_of("/live")).starts_with("HTTP/1.1 503"));
  EXPECT_TRUE(reply_to(server, std::string(kGet) + "\r\n").starts_with("HTTP/1.1 200"));
  for (Browser& page : pages) EXPECT_FALSE(page.closed());

  pages.pop_back();
  server.run();
  EXPECT_TRUE(reply_to(server, upgrade_of("/live")).starts_with("HTTP/1.1 101"));
}

TEST(HttpSession, ServesFoxgloveWhatItSubscribesToAndNoPage) {
  Server server;
  TopicBoard& topics = server.open_to_foxglove();
  const dds::RawTopic topic{.name = "scene/signals", .type = "cordis::msg::SceneSignals"};
  topics.set_writers({{.id = {1}, .topic = topic, .partitions = {}}}, {});
  Browser foxglove = server.connect();

  foxglove.say(upgrade_of("/", kFoxgloveFields));
  server.run();
  const std::string greeting = foxglove.take();
  foxglove.say(frame_of(R"({"op": "subscribe", "subscriptions": [{"id": 3, "channelId": 1}]})"));
  server.run();
  const bool is_wanted = topics.is_wanted(topic);
  const std::array<std::uint8_t, 5> bytes{0, 1, 0, 0, 'x'};
  topics.add(topic, {.data = bytes.data(), .size = bytes.size(), .reception_nsec = 1});
  for (FoxgloveSession* client : server.state().foxglove_clients) client->pump();
  server.run();
  const std::string message = foxglove.take();
  foxglove.end();
  server.run();

  EXPECT_TRUE(greeting.starts_with("HTTP/1.1 101")) << greeting;
  EXPECT_NE(greeting.find("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"), std::string::npos);
  EXPECT_NE(greeting.find("greeting of Foxglove"), std::string::npos);
  EXPECT_EQ(greeting.find("may command"), std::string::npos);
  EXPECT_NE(greeting.find(R"("topic":"scene/signals")"), std::string::npos);
  EXPECT_TRUE(is_wanted);
  EXPECT_EQ(message, std::string("\x82\x12\x01\x03\0\0\0\x01\0\0\0\0\0\0\0\0\x01\0\0x", 20));
  EXPECT_FALSE(topics.is_wanted(topic)) << "nothing is read for a client that left";
  EXPECT_EQ(server.state().connections, 0u);
}

TEST(HttpSession, RefusesFoxgloveInASentenceThatNamesTheKey) {
  Server server;
  const std::string reply = reply_to(server, upgrade_of("/", kFoxgloveFields));

  EXPECT_TRUE(reply.starts_with("HTTP/1.1 403")) << reply;
  EXPECT_NE(reply.find("foxglove: true"), std::string::npos);
}

TEST(HttpSession, ServesAPageBesideFoxgloveAndEndsATextThatIsTooLong) {
  Server server;
  server.open_to_foxglove();
  Browser foxglove = server.connect();
  foxglove.say(upgrade_of("/", kFoxgloveFields));
  server.run();
  foxglove.take();
  std::string text = std::string("\x81\xff\0\0\0\0\0\0\x40\x01", 10) + std::string(4, '\0');
  foxglove.say(text + std::string(kLongestFromFoxglove + 1, ' '));
  server.run();

  EXPECT_NE(foxglove.take().find("\x88"), std::string::npos) << "a close frame";
  EXPECT_TRUE(may_command(server, "/live"));
}

/// A request, or the beginning of a page, with some bytes changed, doubled or left out.
std::string malformed_request(std::mt19937& random) {
  const auto below = [&random](std::size_t limit) { return random() % limit; };
  const std::array<std::string, 6> sound{
      upgrade_of("/", kFoxgloveFields) + frame_of(R"({"op": "subscribe", "subscriptions": []})"),
      std::string(kGet) + "\r\n",
      upgrade_of("/live") + frame_of(R"({"type": "ack"})"),
      std::string(kGet) + "Content-Length: 5\r\n\r\nhello",
      std::string(kGet) + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n",
      std::string(kGet) + "X: " + std::string(9000, 'x') + "\r\n\r\n"};
  std::string request = sound[below(sound.size())];
  for (std::size_t changes = 1 + below(8); changes > 0; --changes) {
    const std::size_t first = below(request.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(16, request.size() - first));
    switch (below(4)) {
      case 0:
        request[first] = static_cast<char>(below(256));
        break;
      case 1:
        request.insert(first, request.substr(first, length));
        break;
      case 2:
        if (length < request.size()) request.erase(first, length);
        break;
      default:
        request.insert(first, below(2) == 0 ? "\r\n" : std::string(1, '\0'));
    }
  }
  return request;
}

TEST(HttpSession, AnswersAfterTenThousandMalformedRequests) {
  Server server;
  server.open_to_foxglove();
  std::mt19937 random(20);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same each time
  std::vector<Browser> open;
  for (int i = 0; i < 10'000; ++i) {
    open.push_back(server.connect());
    open.back().say(malformed_request(random));
    server.run();
    if (open.size() < 100) continue;
    ASSERT_LE(server.state().requests.size(), kMaxRequests);
    ASSERT_TRUE(reply_to(server, std::string(kGet) + "\r\n").starts_with("HTTP/1.1 200")) << i;
    open.clear();
    server.run();
    ASSERT_EQ(server.state().connections, 0u) << i;
  }
}

}  // namespace
}  // namespace cordis::viz
