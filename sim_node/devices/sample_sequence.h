// sim_node/devices/sample_sequence.h -- the newest sample of a device, and how many were lost.
#pragma once

#include <cstdint>

namespace cordis::sim {

/// Follows the numbers of the samples of one device, and counts the samples that never came. A lost
/// sample shows as a gap before the next one. Whoever takes part in the session may write a sample,
/// so no number and no time is trusted. A jump by more than kMaxJump, another epoch, or a whole
/// `patience` of older numbers in a row restarts the sequence. Real time: O(1), allocates nothing.
class SampleSequence {
 public:
  static constexpr double kMaxJump = 1.0;  ///< largest jump of the sample numbers [s]

  /// @param rate_hz         samples per second, > 0
  /// @param patience_ticks  samples that make a gap, or a restart when they are older; > 0
  SampleSequence(double rate_hz, int patience_ticks);

  /// What the number of a sample says of it.
  enum class Order : std::uint8_t {
    kNew,       ///< later than the newest one, or the first after a restart
    kRepeated,  ///< the newest one once more
    kOlder      ///< older than the newest one: to be refused
  };
  struct Position {
    Order order = Order::kNew;
    bool restarts = false;   ///< the numbers do not follow from those before
    bool after_gap = false;  ///< `patience` or more lie between this sample and the newest one
  };
  /// Takes a sample. One that is new becomes the newest one.
  [[nodiscard]] Position receive(std::uint64_t epoch, std::uint64_t number,
                                 std::int64_t time_nsec) noexcept;

  /// Goes on behind the newest sample of `before`, with its count of lost samples.
  void continue_from(const SampleSequence& before) noexcept;

  /// Epoch and number of the newest sample; 0 before the first one.
  std::uint64_t epoch() const noexcept { return epoch_; }
  std::uint64_t number() const noexcept { return number_; }
  /// When it was taken, by the clock of its device [ns].
  std::int64_t time_nsec() const noexcept { return time_nsec_; }
  /// Samples of the device that never came; of a jump of their numbers those of kMaxJump.
  std::uint64_t lost_count() const noexcept { return lost_count_; }

 private:
  std::uint64_t max_jump_;  // of the numbers
  int patience_ticks_;
  std::int64_t patience_nsec_;
  std::uint64_t epoch_ = 0;
  std::uint64_t number_ = 0;
  std::int64_t time_nsec_ = 0;
  std::uint64_t lost_count_ = 0;
  int older_in_a_row_ = 0;
};

}  // namespace cordis::sim
