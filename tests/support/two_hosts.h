// tests/support/two_hosts.h -- two hosts with a cable between them that is as bad as a test wants.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace cordis::test {

/// What the cable does to each datagram, in both directions.
struct CableFaults {
  std::chrono::microseconds delay{0};
  std::chrono::microseconds jitter{
      0};               ///< more delay, uniform up to this: datagrams overtake others
  double loss = 0.0;    ///< share that is lost
  bool is_cut = false;  ///< nothing passes
};

/// Two network namespaces of this machine, each with a loopback of its own and one interface `wire0`
/// (192.168.5.1 and 192.168.5.2), and a thread that carries the IP packets between them. It does what
/// `tc netem` does, for kernels that have none. Processes of a namespace see this machine in all
/// other respects: clocks, processes, files.
class TwoHosts {
 public:
  enum Host { kFirst = 0, kSecond = 1 };

  /// The reason why this machine does not permit it (namespaces, /dev/net/tun); empty if it does.
  static std::string why_not();

  /// @param seed  of what is lost and how late it comes
  explicit TwoHosts(std::uint64_t seed = 1);
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// A cut loses what is under way: once this returns, nothing arrives.
  void set(const CableFaults& faults);
  /// Packets that have passed and that were lost, both ways.
  std::uint64_t passed() const noexcept;
  std::uint64_t lost() const noexcept;
  /// Bytes of the largest packet so far, with the headers of IP and UDP.
  std::size_t largest() const noexcept;

  static const char* address(Host host) { return host == kFirst ? "192.168.5.1" : "192.168.5.2"; }

  /// Calls `work` in a thread whose sockets are those of the host, as are those of the threads that
  /// it starts.
  void run_on(Host host, const std::function<void()>& work) const;

  /// The words that start a program on the host.
  std::vector<std::string> on(Host host, std::vector<std::string> words) const;

 private:
  struct Cable;
  std::array<int, 2> namespaces_{-1, -1};
  std::unique_ptr<Cable> cable_;
};

}  // namespace cordis::test
