// node/latest.h -- the newest of a value, handed from one thread to another without a lock.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace cordis::node {

/// Three places for a value: one thread puts, another takes the newest. Neither waits for the other,
/// and a value that is not taken in time is replaced. Real time: O(size of the value), no allocation.
template <class Value>
class Latest {
 public:
  /// In the thread that puts.
  void put(const Value& value) noexcept {
    places_[writing_] = value;
    const std::uint8_t before = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = before & kPlace;
  }

  /// In the thread that takes: true if there is a value newer than the one taken last.
  bool take(Value& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kPlace;
    value = places_[reading_];
    return true;
  }

 private:
  static constexpr std::uint8_t kFresh = 4;  // no thread has taken the place in the middle yet
  static constexpr std::uint8_t kPlace = 3;

  std::array<Value, 3> places_{};
  std::uint8_t writing_ = 0;
  std::uint8_t reading_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace cordis::node
