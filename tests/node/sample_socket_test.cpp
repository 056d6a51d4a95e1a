// tests/node/sample_socket_test.cpp
#include "node/dds/sample_socket.h"

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/udp_address.h"
#include "node/time.h"
#include "tests/support/eventually.h"

namespace cordis::dds {
namespace {

/// The smallest that DDS may read: a header, and a submessage of padding [DDSI-RTPS 8.3.7.11].
struct Message {
  std::array<char, 4> magic{'R', 'T', 'P', 'S'};
  std::array<std::uint8_t, 16> header{2, 3, 1, 15, 7};  // version, vendor, who sends
  std::array<std::uint8_t, 4> padding{0x01, 0x01, 4, 0};
  std::uint32_t number = 0;
};

/// Counts how often each datagram is delivered; only one thread may be in here.
class Counter final : public SampleSocket::Receiver {
 public:
  explicit Counter(std::size_t datagrams) : times_(datagrams) {}
  void OnDataReceived(const eprosima::fastrtps::rtps::octet* data, const std::uint32_t size,
                      const SampleSocket::Locator& local,
                      const SampleSocket::Locator& remote) override {
    EXPECT_FALSE(is_in_use_.exchange(true)) << "two threads at once";
    Message message;
    ASSERT_EQ(size, sizeof message);
    std::memcpy(&message, data, sizeof message);
    const std::uint32_t number = message.number;
    ++times_.at(number);
    local_ = local;
    remote_ = remote;
    is_in_use_ = false;
    ++count_;
  }
  const std::vector<int>& times() const { return times_; }
  int count() const { return count_; }
  const SampleSocket::Locator& local() const { return local_; }
  const SampleSocket::Locator& remote() const { return remote_; }

 private:
  std::vector<int> times_;
  std::atomic<int> count_{0};
  std::atomic<bool> is_in_use_{false};
  SampleSocket::Locator local_;
  SampleSocket::Locator remote_;
};

/// A socket on a port of this host.
class Sender {
 public:
  Sender() {
    const sockaddr_in any = udp_address(0);
    EXPECT_EQ(bind(file_, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
    socklen_t size = sizeof own_;
    getsockname(file_, reinterpret_cast<sockaddr*>(&own_), &size);
  }
  ~Sender() { close(file_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(std::uint32_t number, std::uint16_t port) const {
    const sockaddr_in to = udp_address(port);
    const Message message{.number = number};
    EXPECT_EQ(sendto(file_, &message, sizeof message, 0, reinterpret_cast<const sockaddr*>(&to),
                     sizeof to),
              static_cast<ssize_t>(sizeof message));
  }
  std::uint16_t port() const { return ntohs(own_.sin_port); }

 private:
  int file_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own_{};
};

/// A socket on a port that is free.
std::unique_ptr<SampleSocket> open(SampleSocket::Receiver& receiver) {
  for (;;) {
    std::uint16_t port = Sender().port();
    SampleSocket::Locator locator(LOCATOR_KIND_UDPv4, port);
    try {
      return std::make_unique<SampleSocket>("127.0.0.1", locator, receiver, 1u << 20, 1000u);
    } catch (const std::system_error&) {  // another process took it
    }
  }
}

std::uint16_t port_of(const SampleSocket& socket) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  getsockname(socket.file(), reinterpret_cast<sockaddr*>(&own), &size);
  EXPECT_EQ(own.sin_addr.s_addr, htonl(INADDR_LOOPBACK));
  return ntohs(own.sin_port);
}

TEST(SampleSocket, DeliversEachDatagramOnceWhateverThreadsTakeThem) {
  constexpr std::uint32_t kSent = 3000;
  Counter counter(kSent);
  const auto socket = open(counter);
  const std::uint16_t port = port_of(*socket);
  const Sender sender;
  std::atomic<bool> is_over{false};
  std::vector<std::thread> takers;
  for (int n = 0; n < 3; ++n) {
    takers.emplace_back([&] {
      while (!is_over) {
        socket->begin_wait();
        if (socket->take() == SampleSocket::Taken::kDatagram) socket->deliver();
        socket->end_wait();
      }
    });
  }
  for (std::uint32_t n = 0; n < kSent; ++n) {
    sender.send(n, port);
    if (!test::eventually([&] { return counter.count() + 500 >= static_cast<int>(n); })) break;
  }
  EXPECT_TRUE(test::eventually([&] { return counter.count() == static_cast<int>(kSent); }));
  is_over = true;
  for (std::thread& taker : takers) taker.join();

  EXPECT_EQ(counter.times(), std::vector<int>(kSent, 1));
  EXPECT_EQ(counter.local().port, port);
  EXPECT_EQ(counter.remote().port, sender.port());
  EXPECT_EQ(counter.remote().kind, LOCATOR_KIND_UDPv4);
  const std::array<std::uint8_t, 4> loopback{127, 0, 0, 1};
  EXPECT_EQ(std::memcmp(counter.remote().address + 12, loopback.data(), 4), 0);
}

TEST(SampleSocket, IsAttendedWhileALoopWaitsAndForAWhileAfter) {
  Counter counter(1);
  const auto socket = open(counter);
  EXPECT_FALSE(socket->is_attended());
  socket->begin_wait();
  EXPECT_TRUE(socket->is_attended());
  node::sleep_until(node::monotonic_nsec() + 2 * SampleSocket::kAttended);
  EXPECT_TRUE(socket->is_attended()) << "it still waits";
  socket->end_wait();
  node::sleep_until(node::monotonic_nsec() + 2 * SampleSocket::kAttended);
  EXPECT_FALSE(socket->is_attended());
  socket->begin_wait();
  socket->end_wait();
  socket->leave();
  EXPECT_FALSE(socket->is_attended());
}

TEST(SampleSocket, DeliversNothingOnceDdsIsGone) {
  Counter counter(2);
  const auto socket = open(counter);
  const Sender sender;
  const std::uint16_t port = port_of(*socket);
  EXPECT_EQ(socket->take(), SampleSocket::Taken::kNothing) << "nothing has come";
  sender.send(0, port);
  ASSERT_EQ(socket->take(), SampleSocket::Taken::kDatagram);
  std::thread([&] { EXPECT_EQ(socket->take(), SampleSocket::Taken::kBusy); }).join();
  socket->deliver();
  socket->detach();
  sender.send(1, port);
  EXPECT_EQ(socket->take(), SampleSocket::Taken::kNothing);
  EXPECT_EQ(counter.count(), 1);
}

TEST(SampleSocket, SaysWhichPortIsTaken) {
  Counter counter(1);
  const auto socket = open(counter);
  const std::uint16_t port = port_of(*socket);
  const SampleSocket::Locator taken(LOCATOR_KIND_UDPv4, port);
  try {
    const SampleSocket another("127.0.0.1", taken, counter, 1u << 16, 1000u);
    FAIL() << "it shares the port";
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find("127.0.0.1:" + std::to_string(port)),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace cordis::dds
