// sim_node/frame_store.cpp
#include "sim_node/frame_store.h"

#include <algorithm>
#include <utility>

namespace cordis::sim {

FrameStore::FrameStore(FrameShape shape)
    : shape_(std::move(shape)),
      row_capacity_(shape_.rows_per_frame * kFramesOfRows),
      discarded_row_(shape_.signal_count) {
  for (FrameBuffer& buffer : buffers_) {
    buffer.positions.resize(4 * shape_.mat_count);
    buffer.rows.resize(row_capacity_ * shape_.signal_count);
  }
}

double* FrameStore::next_row(std::uint64_t step) noexcept {
  FrameBuffer& buffer = buffers_[filling_];
  if (buffer.row_count == row_capacity_) {
    ++overflowed_rows_;
    return discarded_row_.data();
  }
  if (buffer.row_count == 0) buffer.first_step = step;
  return buffer.rows.data() + shape_.signal_count * buffer.row_count++;
}

void FrameStore::turn(const engine::World& world, double simulated_s,
                      std::int64_t now_nsec) noexcept {
  FrameBuffer& buffer = buffers_[filling_];
  std::copy_n(world.positions().data(), buffer.positions.size(), buffer.positions.begin());
  buffer.step = world.step_count();
  buffer.simulated_s = simulated_s;
  buffer.time_nsec = now_nsec;

  filling_ = 1 - filling_;
  buffers_[filling_].row_count = 0;
  buffers_[filling_].dropped_rows = std::exchange(overflowed_rows_, 0);
}

}  // namespace cordis::sim
