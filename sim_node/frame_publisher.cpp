// sim_node/frame_publisher.cpp
#include "sim_node/frame_publisher.h"

#include <algorithm>
#include <utility>

namespace cordis::sim {

FramePublisher::FramePublisher(dds::Participant& participant, std::uint64_t run,
                               std::size_t mat_count, std::size_t signal_count,
                               std::size_t rows_per_frame, std::uint32_t stride_steps,
                               Layout layout)
    : frame_writer_(participant, dds::Topic::kFrame),
      signal_writer_(participant, dds::Topic::kSignals),
      layout_(std::move(layout)),
      signal_count_(signal_count),
      row_capacity_(rows_per_frame * kFramesOfRows),
      discarded_row_(signal_count) {
  for (Buffer& buffer : buffers_) {
    buffer.positions.resize(4 * mat_count);
    buffer.rows.resize(row_capacity_ * signal_count_);
  }
  frame_.run(run);
  frame_.position_m().resize(3 * mat_count);
  signals_.run(run);
  signals_.signal_count(static_cast<std::uint32_t>(signal_count));
  signals_.stride_steps(stride_steps);
  signals_.value().reserve(row_capacity_ * signal_count_);
  thread_ = std::thread([this] { loop(); });
}

FramePublisher::~FramePublisher() {
  ending_.store(true);
  offered_.release();
  thread_.join();
}

double* FramePublisher::next_row(std::uint64_t step) noexcept {
  Buffer& buffer = buffers_[filling_];
  if (buffer.row_count == row_capacity_) {
    ++overflowed_rows_;
    return discarded_row_.data();
  }
  if (buffer.row_count == 0) buffer.first_step = step;
  return buffer.rows.data() + signal_count_ * buffer.row_count++;
}

bool FramePublisher::offer_frame(const engine::World& world, double simulated_s,
                                 std::int64_t now_nsec) noexcept {
  if (busy_.load(std::memory_order_acquire)) {
    frames_left_out_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  Buffer& buffer = buffers_[filling_];
  std::copy_n(world.positions().data(), buffer.positions.size(), buffer.positions.begin());
  buffer.step = world.step_count();
  buffer.simulated_s = simulated_s;
  buffer.time_nsec = now_nsec;

  filling_ = 1 - filling_;
  buffers_[filling_].row_count = 0;
  buffers_[filling_].dropped_rows = std::exchange(overflowed_rows_, 0);
  busy_.store(true, std::memory_order_release);
  offered_.release();
  return true;
}

void FramePublisher::loop() {
  for (;;) {
    offered_.acquire();
    if (busy_.load(std::memory_order_acquire)) {
      publish(buffers_[1 - filling_]);
      busy_.store(false, std::memory_order_release);
      busy_.notify_one();
    }
    if (ending_.load()) return;
  }
}

void FramePublisher::publish(const Buffer& buffer) {
  const auto mat_count = buffer.positions.size() / 4;
  std::vector<float>& position = frame_.position_m();
  for (std::size_t mat = 0; mat < mat_count; ++mat) {
    const double* x = buffer.positions.data() + 4 * mat;
    float* shown = position.data() + 3 * mat;
    if (layout_.dimension == 1) {
      shown[0] = layout_.x_z[2 * mat];
      shown[1] = static_cast<float>(x[0]);
      shown[2] = layout_.x_z[2 * mat + 1];
    } else {
      for (int i = 0; i < 3; ++i) shown[i] = static_cast<float>(x[i]);
    }
  }
  frame_.frame(frame_.frame() + 1);
  frame_.step(buffer.step);
  frame_.time_nsec(buffer.time_nsec);
  frame_.simulated_s(buffer.simulated_s);
  frame_writer_.write(frame_);

  if (signal_count_ == 0) return;
  signals_.batch(signals_.batch() + 1);
  signals_.first_step(buffer.first_step);
  signals_.dropped_rows(buffer.dropped_rows);
  const auto values = static_cast<std::ptrdiff_t>(buffer.row_count * signal_count_);
  signals_.value().assign(buffer.rows.begin(), buffer.rows.begin() + values);
  signal_writer_.write(signals_);
}

}  // namespace cordis::sim
