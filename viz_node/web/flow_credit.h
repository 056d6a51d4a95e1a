// viz_node/web/flow_credit.h -- how many frames a client may have before it says that it has
// drawn one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cordis::viz {

/// The flow-control credit of one client: at most two frames are on their way to it, then it must
/// acknowledge one.
///
/// A writable socket says nothing about the browser: kernel and browser hold seconds of frames.
/// Newest wins: while a client has no credit the frames pass it by, and count as dropped.
///
/// No client can lose its credit for good. What is on its way is computed from the newest
/// acknowledgement; reset() forgets it; a frame that is not acknowledged in time is given up. So
/// may_send() of a frame that is due is true at the latest kAckTimeoutNsec after the last sent(), whatever
/// the client acknowledges or leaves out. Pure logic, the caller's clock, O(1) memory.
class FlowCredit {
 public:
  static constexpr std::size_t kMaxUnacknowledged = 2;

  /// Longer than two frames of a megabyte take on a line of 10 Mbit/s: a slow client is not taken
  /// for one that never acknowledges.
  static constexpr std::int64_t kAckTimeoutNsec = 3'000'000'000;

  /// @param every  of so many frames the client gets one
  explicit FlowCredit(std::uint32_t every = 1) noexcept;

  /// True if the frame `newest` is the next one that the client gets, or newer, and there is credit
  /// for it.
  /// @param now_nsec  steady clock, never backwards [ns]
  bool may_send(std::uint32_t newest, std::int64_t now_nsec) const noexcept;

  /// Counts frame `sequence` as on its way; only after may_send(sequence). Without free credit the
  /// oldest frame on its way is given up.
  void sent(std::uint32_t sequence, std::int64_t taken_nsec, std::int64_t now_nsec) noexcept;

  /// The client is done with every frame up to `sequence`. Gives back when that frame was taken, or
  /// nothing when it was not on its way (acknowledged before, given up, or never sent).
  std::optional<std::int64_t> acknowledge(std::uint32_t sequence) noexcept;

  /// Gives all credit back: another scene begins, and no page waits for frames of the last one.
  void reset() noexcept { count_ = 0; }

  std::size_t unacknowledged() const noexcept { return count_; }
  std::uint32_t dropped() const noexcept {
    return dropped_;
  }  ///< due frames passed by since the first one sent

 private:
  struct Flight {
    std::uint32_t sequence = 0;
    std::int64_t taken_nsec = 0;
  };

  void forget_oldest(std::size_t flights) noexcept;

  std::uint32_t every_;
  std::array<Flight, kMaxUnacknowledged> flights_{};  // oldest first
  std::size_t count_ = 0;
  std::uint32_t last_sent_ = 0;  // 0: none yet
  std::int64_t last_sent_nsec_ = 0;
  std::uint32_t dropped_ = 0;
};

}  // namespace cordis::viz
