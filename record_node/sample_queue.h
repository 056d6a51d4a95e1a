// record_node/sample_queue.h -- what waits between the threads of DDS and the disk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace cordis::record {

/// A message on its way to the file.
struct QueuedSample {
  std::uint32_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_nsec = 0;
  std::uint64_t publish_time_nsec = 0;
  std::size_t offset = 0;  ///< start of its bytes in those of the batch
  std::size_t size = 0;
};

/// Messages that were taken out of the queue together, in the order in which they came.
struct SampleBatch {
  std::vector<QueuedSample> samples;
  std::vector<std::uint8_t> bytes;

  std::span<const std::uint8_t> data(const QueuedSample& sample) const {
    return std::span(bytes).subspan(sample.offset, sample.size);
  }
};

/// A queue with a bound in bytes. When the disk is slow, large messages that the next one replaces
/// give way first: they may take half of the room.
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Adds a message. @param sample  its offset and size are filled in here
  /// @param is_frame  whether it gives way: it may take half of the room, and one always fits
  /// @return false when there is no room: it is dropped
  [[nodiscard]] bool push(QueuedSample sample, std::span<const std::uint8_t> data, bool is_frame);

  /// Takes all that waits; `batch` gets it and gives its memory for what comes. Waits, at most so
  /// long, until a quarter of the room is taken or interrupt() is called.
  void take(SampleBatch& batch, std::chrono::milliseconds at_most);

  /// Ends a take() of another thread, now or the next time it begins.
  void interrupt();

  std::size_t waiting_bytes() const;

 private:
  const std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  SampleBatch waiting_;
  bool has_frame_ = false;
  bool interrupted_ = false;
};

}  // namespace cordis::record
