// viz_node/web/client_credit.h -- how many frames a client may have before it says that it has
// drawn one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cordis::viz {

/// The credit of one client: at most two frames are on their way to it, then it must acknowledge
/// one.
///
/// Whether its socket can be written says nothing: kernel and browser would hold seconds of frames.
/// Newest wins: while a client has no credit the frames pass it by, and count as dropped. Pure
/// logic, no clock, O(1) memory.
class ClientCredit {
 public:
  static constexpr std::size_t kMostUnacknowledged = 2;

  /// Whether the frame `newest` may be sent: there is credit, and it was not sent before.
  bool may_send(std::uint32_t newest) const noexcept;

  /// Notes that frame `sequence` is on its way; only after may_send(sequence).
  void sent(std::uint32_t sequence, std::int64_t taken_nsec) noexcept;

  /// The client is done with every frame up to `sequence`. Gives back when that frame was taken, or
  /// nothing when it was not on its way (acknowledged before, or never sent).
  std::optional<std::int64_t> acknowledge(std::uint32_t sequence) noexcept;

  std::size_t unacknowledged() const noexcept { return count_; }
  std::uint32_t dropped() const noexcept {
    return dropped_;
  }  ///< frames passed by since the first one sent

 private:
  struct Flight {
    std::uint32_t sequence = 0;
    std::int64_t taken_nsec = 0;
  };

  std::array<Flight, kMostUnacknowledged> flights_{};  // oldest first
  std::size_t count_ = 0;
  std::uint32_t last_sent_ = 0;  // 0: none yet
  std::uint32_t dropped_ = 0;
};

}  // namespace cordis::viz
