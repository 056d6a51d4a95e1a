// record_node/sample_queue.cpp
#include "record_node/sample_queue.h"

#include <utility>

namespace cordis::record {

bool SampleQueue::push(QueuedSample sample, std::span<const std::uint8_t> data, bool is_frame) {
  bool wake = false;
  {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint8_t>& bytes = waiting_.bytes;
    const std::size_t room = is_frame ? max_bytes_ / 2 : max_bytes_;
    const bool fits = bytes.size() + data.size() <= room;
    if (!fits && (!is_frame || has_frame_)) return false;
    sample.offset = bytes.size();
    sample.size = data.size();
    bytes.insert(bytes.end(), data.begin(), data.end());
    waiting_.samples.push_back(sample);
    has_frame_ = has_frame_ || is_frame;
    wake = bytes.size() >= max_bytes_ / 4;
  }
  if (wake) filled_.notify_one();
  return true;
}

void SampleQueue::take(SampleBatch& batch, std::chrono::milliseconds at_most) {
  batch.samples.clear();
  batch.bytes.clear();
  std::unique_lock lock(mutex_);
  filled_.wait_for(lock, at_most,
                   [this] { return interrupted_ || waiting_.bytes.size() >= max_bytes_ / 4; });
  interrupted_ = false;
  has_frame_ = false;
  std::swap(batch, waiting_);
}

void SampleQueue::interrupt() {
  {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
  }
  filled_.notify_one();
}

std::size_t SampleQueue::waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  return waiting_.bytes.size();
}

}  // namespace cordis::record
