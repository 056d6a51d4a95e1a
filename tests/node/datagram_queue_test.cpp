// tests/node/datagram_queue_test.cpp
#include "node/dds/datagram_queue.h"

#include <array>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/dds/udp_address.h"

namespace cordis::dds {
namespace {

/// A sender, and a receiver that keeps what it gets until it is read.
class Wire {
 public:
  Wire() : sender_(open()), receiver_(open()) {
    const int bytes = 4 << 20;
    setsockopt(receiver_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    socklen_t size = sizeof to_;
    getsockname(receiver_, reinterpret_cast<sockaddr*>(&to_), &size);
  }
  ~Wire() {
    close(sender_);
    close(receiver_);
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  int sender() const { return sender_; }
  const sockaddr_in& to() const { return to_; }

  /// The numbers of the datagrams that have come, and whether each is whole.
  std::vector<std::uint32_t> received() const {
    std::vector<std::uint32_t> numbers;
    std::vector<std::uint8_t> bytes(70'000);
    for (;;) {
      const ssize_t size = recv(receiver_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size < 4) return numbers;
      std::uint32_t number = 0;
      std::memcpy(&number, bytes.data(), sizeof number);
      for (ssize_t i = 4; i < size; ++i) EXPECT_EQ(bytes[i], number % 251) << number;
      numbers.push_back(number);
    }
  }

 private:
  static int open() {
    const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in any = udp_address(0);
    EXPECT_EQ(bind(file, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
    return file;
  }

  int sender_;
  int receiver_;
  sockaddr_in to_{};
};

std::vector<std::uint8_t> datagram_of(std::uint32_t number, std::size_t size) {
  std::vector<std::uint8_t> bytes(size, static_cast<std::uint8_t>(number % 251));
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::vector<std::uint32_t> first(std::uint32_t count) {
  std::vector<std::uint32_t> numbers(count);
  for (std::uint32_t n = 0; n < count; ++n) numbers[n] = n;
  return numbers;
}

TEST(DatagramQueue, SendsNothingBeforeItIsToldTo) {
  const Wire wire;
  DatagramQueue queue(wire.sender());
  EXPECT_EQ(queue.flush(), 0u);
  for (std::uint32_t n = 0; n < 3; ++n) {
    const auto bytes = datagram_of(n, 300);
    EXPECT_TRUE(queue.put(bytes.data(), 300, wire.to()));
  }
  EXPECT_EQ(wire.received(), first(0));
  EXPECT_EQ(queue.flush(), 3u);
  EXPECT_EQ(wire.received(), first(3));
  EXPECT_EQ(queue.flush(), 0u);
}

TEST(DatagramQueue, LosesNoneAndKeepsTheirOrderWhateverTheirNumberAndSize) {
  std::mt19937 random(20261126);
  std::uniform_int_distribution<std::uint32_t> sizes(4, 2 * DatagramQueue::kLongest);
  std::uniform_int_distribution<int> one_of(0, 399);
  const Wire wire;
  DatagramQueue queue(wire.sender());
  std::vector<std::uint32_t> received;
  const auto receive = [&] {
    for (const std::uint32_t number : wire.received()) received.push_back(number);
  };
  constexpr std::uint32_t kSent = 5 * DatagramQueue::kRoom;
  for (std::uint32_t n = 0; n < kSent; ++n) {
    const std::uint32_t size = one_of(random) < 2 ? sizes(random) : 4 + sizes(random) / 3;
    const auto bytes = datagram_of(n, size);
    EXPECT_TRUE(queue.put(bytes.data(), size, wire.to()));
    if (one_of(random) == 0) queue.flush();
    if (n % 50 == 0) receive();  // the kernel keeps so many
  }
  queue.flush();
  receive();
  EXPECT_EQ(received, first(kSent));
}

TEST(DatagramQueue, KeepsTheOrderWhileAnotherThreadSends) {
  const Wire wire;
  DatagramQueue queue(wire.sender());
  std::atomic<bool> is_over{false};
  std::thread sender([&] {
    while (!is_over) queue.flush();
  });
  std::vector<std::uint32_t> received;
  constexpr std::uint32_t kSent = 20 * DatagramQueue::kRoom;
  for (std::uint32_t n = 0; n < kSent; ++n) {
    const auto bytes = datagram_of(n, 200);
    EXPECT_TRUE(queue.put(bytes.data(), 200, wire.to()));
    if (n % 100 == 0) {
      for (const std::uint32_t number : wire.received()) received.push_back(number);
    }
  }
  is_over = true;
  sender.join();
  queue.flush();
  for (const std::uint32_t number : wire.received()) received.push_back(number);
  EXPECT_EQ(received, first(kSent));
}

TEST(DatagramQueue, SaysThatTheSocketDidNotTakeOne) {
  const Wire wire;
  DatagramQueue queue(wire.sender());
  const auto bytes = datagram_of(0, 66'000);  // more than UDP carries
  EXPECT_FALSE(queue.put(bytes.data(), 66'000, wire.to()));
}

}  // namespace
}  // namespace cordis::dds
