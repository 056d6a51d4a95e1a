// tests/device/plug.h -- the far end of a wire: a pseudo-terminal or UDP, with a thread behind it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include <netinet/in.h>

namespace cordis::test {

/// An emulated device's end. What arrives is handed to `receive`, on a thread of its own, which
/// also calls `idle` about every millisecond; `say` answers from there, and harms what it is asked to
/// to.
class Plug {
 public:
  Plug(std::function<void(std::uint8_t)> receive, std::function<void()> idle)
      : receive_(std::move(receive)), idle_(std::move(idle)) {}
  ~Plug() { pull(); }
  Plug(const Plug&) = delete;
  Plug& operator=(const Plug&) = delete;

  void into_serial_line(const std::filesystem::path& link);  ///< a path that leads to it
  int into_udp();                                            ///< the port of it
  void pull();

  /// A board does not share this machine's processors: its thread has the highest realtime priority
  /// where that is permitted. False for a board that computes much.
  bool is_prompt = true;

  /// What happens to the n-th answer.
  enum class Harm { kNone, kFlipped, kCut, kDropped, kLate };
  std::function<Harm(int)> harm = [](int) { return Harm::kNone; };

  /// Harms four of ten answers: a wrong bit, a missing byte, no answer, and one that comes with the
  /// next. All bits and bytes get their turn.
  static Harm every_kind(int n);

  /// The longest that its thread has been held up so far; a turn that has not ended counts.
  std::chrono::nanoseconds longest_turn() const noexcept;
  bool has_stalled() const noexcept { return longest_turn() > std::chrono::milliseconds(50); }

  void say_nothing();  ///< an empty datagram
  void say(std::span<const std::uint8_t> bytes);

 private:
  void step();

  std::function<void(std::uint8_t)> receive_;
  std::function<void()> idle_;
  std::thread thread_;
  std::atomic<bool> lives_{false};
  std::atomic<std::int64_t> turn_begin_nsec_{0};  // CLOCK_MONOTONIC
  std::atomic<std::int64_t> longest_turn_nsec_{0};
  int wire_ = -1;
  std::filesystem::path link_;  // of a serial line
  int keeper_ = -1;
  bool udp_ = false;
  sockaddr_in peer_{};
  int answers_ = 0;
  std::vector<std::uint8_t> late_;
};

}  // namespace cordis::test
