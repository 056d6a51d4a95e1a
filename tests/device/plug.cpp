// tests/device/plug.cpp
#include "tests/device/plug.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include "node/time.h"
#include "tests/support/pseudo_terminal.h"

namespace cordis::test {

std::chrono::nanoseconds Plug::longest_turn() const noexcept {
  const std::int64_t present = lives_ ? node::monotonic_nsec() - turn_begin_nsec_ : 0;
  return std::chrono::nanoseconds(std::max(longest_turn_nsec_.load(), present));
}

void Plug::into_serial_line(const std::filesystem::path& link) {
  wire_ = open_board_end();
  // Held open, so that there is no end of file while the driver is away.
  keeper_ = open_node_end(wire_);
  std::filesystem::remove(link);
  std::filesystem::create_symlink(ptsname(wire_), link);
  link_ = link;
  step();
}

int Plug::into_udp() {
  wire_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(bind(wire_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  getsockname(wire_, reinterpret_cast<sockaddr*>(&address), &size);
  udp_ = true;
  step();
  return ntohs(address.sin_port);
}

void Plug::pull() {
  lives_ = false;
  if (thread_.joinable()) thread_.join();
  std::error_code ignored;
  if (!link_.empty())
    std::filesystem::remove(link_,
                            ignored);  // the number of the line may soon be that of another board
  link_.clear();
  if (keeper_ >= 0) close(keeper_);
  if (wire_ >= 0) close(wire_);
  wire_ = keeper_ = -1;
}

void Plug::step() {
  lives_ = true;
  turn_begin_nsec_ = node::monotonic_nsec();
  thread_ = std::thread([this] {
    const sched_param priority{sched_get_priority_max(SCHED_FIFO)};
    if (is_prompt) pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    while (lives_) {
      const std::int64_t now = node::monotonic_nsec();
      const std::int64_t begin = turn_begin_nsec_.exchange(now);
      longest_turn_nsec_ = std::max(longest_turn_nsec_.load(), now - begin);
      pollfd poll_on{wire_, POLLIN, 0};
      poll(&poll_on, 1, 1);
      std::uint8_t bytes[256];
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const ssize_t count =
          udp_ ? recvfrom(wire_, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size)
               : ::read(wire_, bytes, sizeof bytes);
      if (udp_ && count > 0) peer_ = from;
      for (ssize_t i = 0; i < count; ++i) receive_(bytes[i]);
      idle_();
    }
  });
}

Plug::Harm Plug::every_kind(int n) {
  if (n % 10 == 2) return Harm::kFlipped;
  if (n % 10 == 4) return Harm::kCut;
  if (n % 10 == 6) return Harm::kDropped;
  if (n % 10 == 8) return Harm::kLate;
  return Harm::kNone;
}

void Plug::say_nothing() {
  sendto(wire_, nullptr, 0, 0, reinterpret_cast<sockaddr*>(&peer_), sizeof peer_);
}

void Plug::say(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> frame(bytes.begin(), bytes.end());
  const Harm harmed = harm(answers_++);
  if (harmed == Harm::kDropped) return;
  const auto turn = static_cast<std::size_t>(answers_ / 10);
  const std::size_t harmed_byte = turn % frame.size();
  if (harmed == Harm::kFlipped) frame[harmed_byte] ^= static_cast<std::uint8_t>(1u << turn * 3 % 8);
  if (harmed == Harm::kCut) frame.erase(frame.begin() + static_cast<std::ptrdiff_t>(harmed_byte));
  late_.insert(late_.end(), frame.begin(), frame.end());
  if (harmed == Harm::kLate) return;  // comes together with the next one
  const ssize_t sent = udp_ ? sendto(wire_, late_.data(), late_.size(), 0,
                                     reinterpret_cast<sockaddr*>(&peer_), sizeof peer_)
                            : ::write(wire_, late_.data(), late_.size());
  EXPECT_EQ(sent, static_cast<ssize_t>(late_.size()));
  late_.clear();
}

}  // namespace cordis::test
