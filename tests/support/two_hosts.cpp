// tests/support/two_hosts.cpp
#include "tests/support/two_hosts.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <mutex>
#include <queue>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cordis::test {
namespace {

using Clock = std::chrono::steady_clock;

std::runtime_error failure(const std::string& what) {
  return std::runtime_error(what + ": " + std::strerror(errno));
}

ifreq request_for(const char* interface) {
  ifreq request{};
  std::snprintf(request.ifr_name, sizeof request.ifr_name, "%s", interface);
  return request;
}

void set_address(int file, const char* interface, unsigned long what, const char* address) {
  ifreq request = request_for(interface);
  auto* place = reinterpret_cast<sockaddr_in*>(&request.ifr_addr);
  place->sin_family = AF_INET;
  inet_pton(AF_INET, address, &place->sin_addr);
  if (ioctl(file, what, &request) != 0) throw failure(std::string("cannot address ") + interface);
}

void bring_up(int file, const char* interface) {
  ifreq request = request_for(interface);
  if (ioctl(file, SIOCGIFFLAGS, &request) != 0) throw failure("cannot read flags");
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
  if (ioctl(file, SIOCSIFFLAGS, &request) != 0)
    throw failure(std::string("cannot bring up ") + interface);
}

/// Moves the calling thread into a network of its own. @return its end of the cable
int begin_host(const char* address) {
  if (unshare(CLONE_NEWNET) != 0) throw failure("no network namespace");
  const int wire = open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (wire < 0) throw failure("no /dev/net/tun");
  ifreq request = request_for("wire0");
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (ioctl(wire, TUNSETIFF, &request) != 0) throw failure("no TUN interface");
  const int file = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  bring_up(file, "lo");
  set_address(file, "wire0", SIOCSIFADDR, address);
  set_address(file, "wire0", SIOCSIFNETMASK, "255.255.255.0");
  bring_up(file, "wire0");
  close(file);
  return wire;
}

/// Calls `work` in a thread of its own, and throws what it throws.
void in_a_thread(const std::function<void()>& work) {
  std::exception_ptr thrown;
  std::thread([&] {
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
  }).join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace

/// Carries packets from each end to the other.
struct TwoHosts::Cable {
  struct Packet {
    Clock::time_point due;
    std::uint64_t number = 0;  // of those due at the same time the first comes first
    int to = 0;
    std::vector<std::uint8_t> bytes;
  };

  struct LaterFirst {
    bool operator()(const Packet& a, const Packet& b) const {
      return std::pair(a.due, a.number) > std::pair(b.due, b.number);
    }
  };

  Cable(std::array<int, 2> files, std::uint64_t seed) : ends(files), random(seed) {
    wake = eventfd(0, EFD_CLOEXEC);
    thread = std::thread([this] { carry(); });
    // A cable does not wait for a processor. Where it is not permitted, it does.
    const sched_param priority{60};
    pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &priority);
  }

  ~Cable() {
    ending = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake, &one, sizeof one);
    thread.join();
    for (const int end : ends) close(end);
    close(wake);
  }

  void carry() {
    while (!ending) {
      wait_for_packets();
      const std::lock_guard lock(mutex);
      for (int from = 0; from < 2; ++from) take_all(from);
      deliver_due();
    }
  }

  timespec until_next_is_due() {
    const std::lock_guard lock(mutex);
    if (waiting.empty()) return {1, 0};
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(waiting.top().due - Clock::now());
    const std::int64_t nsec = std::max<std::int64_t>(left.count(), 0);
    return {nsec / 1'000'000'000, nsec % 1'000'000'000};
  }

  void wait_for_packets() {
    std::array<pollfd, 3> files{{{ends[0], POLLIN, 0}, {ends[1], POLLIN, 0}, {wake, POLLIN, 0}}};
    const timespec limit = until_next_is_due();
    ppoll(files.data(), files.size(), &limit, nullptr);
  }

  void take_all(int from) {
    std::array<std::uint8_t, 2048> block;
    for (;;) {
      const ssize_t size = read(ends[static_cast<std::size_t>(from)], block.data(), block.size());
      if (size <= 0) return;
      largest = std::max(largest.load(), static_cast<std::size_t>(size));
      if (faults.is_cut || chance(random) < faults.loss) {
        ++lost;
        continue;
      }
      const auto late = std::chrono::microseconds(
          static_cast<std::int64_t>(chance(random) * static_cast<double>(faults.jitter.count())));
      waiting.push({Clock::now() + faults.delay + late,
                    ++count,
                    1 - from,
                    {block.begin(), block.begin() + size}});
    }
  }

  void deliver_due() {
    while (!waiting.empty() && waiting.top().due <= Clock::now()) {
      const Packet& packet = waiting.top();
      const ssize_t written = write(ends[static_cast<std::size_t>(packet.to)], packet.bytes.data(),
                                    packet.bytes.size());
      ++(written > 0 ? passed : lost);
      waiting.pop();
    }
  }

  std::array<int, 2> ends;
  int wake = -1;
  std::mt19937_64 random;
  std::uniform_real_distribution<double> chance{0.0, 1.0};
  std::mutex mutex;  // of the next two
  CableFaults faults;
  std::priority_queue<Packet, std::vector<Packet>, LaterFirst> waiting;
  std::uint64_t count = 0;
  std::atomic<std::uint64_t> passed{0};
  std::atomic<std::uint64_t> lost{0};
  std::atomic<std::size_t> largest{0};
  std::atomic<bool> ending{false};
  std::thread thread;
};

std::string TwoHosts::why_not() {
  try {
    in_a_thread([] { close(begin_host("192.168.5.1")); });
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

TwoHosts::TwoHosts(std::uint64_t seed) {
  std::array<int, 2> ends{-1, -1};
  for (const Host host : {kFirst, kSecond}) {
    in_a_thread([&, host] {
      ends[host] = begin_host(address(host));
      namespaces_[host] = open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
    });
  }
  cable_ = std::make_unique<Cable>(ends, seed);
}

TwoHosts::~TwoHosts() {
  cable_.reset();
  for (const int file : namespaces_) close(file);
}

void TwoHosts::set(const CableFaults& faults) {
  const std::lock_guard lock(cable_->mutex);
  cable_->faults = faults;
  while (faults.is_cut && !cable_->waiting.empty()) {
    cable_->waiting.pop();
    ++cable_->lost;
  }
}

std::uint64_t TwoHosts::passed() const noexcept {
  return cable_->passed;
}

std::uint64_t TwoHosts::lost() const noexcept {
  return cable_->lost;
}

std::size_t TwoHosts::largest() const noexcept {
  return cable_->largest;
}

void TwoHosts::run_on(Host host, const std::function<void()>& work) const {
  in_a_thread([&] {
    if (setns(namespaces_[host], CLONE_NEWNET) != 0) throw failure("cannot enter the host");
    work();
  });
}

std::vector<std::string> TwoHosts::on(Host host, std::vector<std::string> words) const {
  words.insert(words.begin(), {"nsenter", "--net=/proc/" + std::to_string(getpid()) + "/fd/" +
                                              std::to_string(namespaces_[host])});
  return words;
}

}  // namespace cordis::test
