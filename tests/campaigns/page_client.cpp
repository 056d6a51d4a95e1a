// tests/campaigns/page_client.cpp
#include "tests/campaigns/page_client.h"

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <sys/socket.h>

namespace cordis::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

constexpr std::string_view kScheme = "http://";
constexpr std::uint8_t kFrame = 1;         // kind of a message
constexpr std::size_t kKindPlace = 5;      // [bytes]
constexpr std::size_t kSequencePlace = 8;  // [bytes], of a frame
constexpr auto kPause = std::chrono::milliseconds(100);

}  // namespace

PageClient::PageClient() : thread_([this] { read(); }) {}

PageClient::~PageClient() {
  ending_ = true;
  {
    const std::lock_guard lock(mutex_);
    if (socket_ >= 0) shutdown(socket_, SHUT_RDWR);
  }
  thread_.join();
}

void PageClient::visit(const std::string& url) {
  const std::lock_guard lock(mutex_);
  url_ = url;
}

void PageClient::read() {
  while (!ending_) {
    std::string url;
    {
      const std::lock_guard lock(mutex_);
      url = url_;
    }
    const std::size_t colon = url.rfind(':');
    if (colon != std::string::npos && colon > kScheme.size())
      read_from(static_cast<std::uint16_t>(std::strtoul(&url[colon + 1], nullptr, 10)));
    if (!ending_) std::this_thread::sleep_for(kPause);
  }
}

void PageClient::read_from(std::uint16_t port) {
  asio::io_context context;
  beast::websocket::stream<asio::ip::tcp::socket> page(context);
  boost::system::error_code error;
  page.next_layer().connect({asio::ip::address_v4::loopback(), port}, error);
  if (error) return;
  {
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    socket_ = page.next_layer().native_handle();
  }
  page.read_message_max(0);
  page.handshake("127.0.0.1:" + std::to_string(port), "/live", error);
  beast::flat_buffer buffer;
  while (!error && !ending_) {
    buffer.clear();
    page.read(buffer, error);
    const auto* bytes = static_cast<const std::uint8_t*>(buffer.data().data());
    if (error || !page.got_binary() || buffer.size() < kSequencePlace + 4) continue;
    if (bytes[kKindPlace] != kFrame) continue;
    std::uint32_t sequence = 0;
    std::memcpy(&sequence, bytes + kSequencePlace, sizeof sequence);
    ++frames_;
    page.text(true);
    const std::string number = std::to_string(sequence);
    page.write(asio::buffer(R"({"type":"ack","drawn":true,"sequence":)" + number + "}"), error);
  }
  const std::lock_guard lock(mutex_);
  socket_ = -1;
}

}  // namespace cordis::test
