// sim_node/frame_publisher.h -- tells the display and the recorder, without ever holding the loop.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>
#include <vector>

#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Publishes scene/frame and scene/signals from a thread of its own.
///
/// The loop fills one of two buffers, row by row, and hands it over when a frame is due and the
/// thread has finished with the other one. When it has not, the frame is left out and the rows stay
/// for the next; rows beyond the buffer are counted as dropped. The loop's side is O(MATs) per
/// frame, takes no lock and allocates nothing.
class FramePublisher {
 public:
  /// How the coordinates of the engine become those of a frame: in a 1-D scene the displacement is
  /// shown along y, at the layout's x and z; otherwise the layout is empty.
  struct Layout {
    int dimension = 3;
    std::vector<float> x_z;  ///< 2 per MAT, 1-D scenes only [m]
  };

  FramePublisher(dds::Participant& participant, std::uint64_t run, std::size_t mat_count,
                 std::size_t signal_count, std::size_t rows_per_frame, std::uint32_t stride_steps,
                 Layout layout);
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Loop: room for the signals of one tick, signal_count values; a place to write to even when the
  /// row is dropped.
  double* next_row(std::uint64_t step) noexcept;

  /// Loop: a frame is due. @return false when it was left out because the thread is still busy.
  bool offer_frame(const engine::World& world, double simulated_s, std::int64_t now_nsec) noexcept;

  /// Loop without real time: waits until the thread has finished with the last frame, so that none
  /// is left out.
  void wait_until_free() const noexcept { busy_.wait(true, std::memory_order_acquire); }

  std::uint64_t frames_left_out() const noexcept {
    return frames_left_out_.load(std::memory_order_relaxed);
  }

 private:
  struct Buffer {
    std::vector<double> positions;  // as World::positions()
    std::vector<double> rows;
    std::size_t row_count = 0;
    std::uint64_t first_step = 0;
    std::uint32_t dropped_rows = 0;  // before its first row
    std::uint64_t step = 0;
    std::int64_t time_nsec = 0;
    double simulated_s = 0.0;
  };

  void loop();
  void publish(const Buffer& buffer);

  static constexpr std::size_t kFramesOfRows = 8;  // rows kept while frames are left out

  dds::Writer<msg::SceneFrame> frame_writer_;
  dds::Writer<msg::SceneSignals> signal_writer_;
  Layout layout_;
  std::size_t signal_count_;
  std::size_t row_capacity_;
  msg::SceneFrame frame_;
  msg::SceneSignals signals_;
  std::vector<double> discarded_row_;

  std::array<Buffer, 2> buffers_;
  std::size_t filling_ = 0;  // the loop's buffer; the other one is the thread's while busy_
  std::uint32_t overflowed_rows_ = 0;  // rows that found the filling buffer full
  std::atomic<bool> busy_{false};
  std::atomic<std::uint64_t> frames_left_out_{0};
  std::atomic<bool> ending_{false};
  std::counting_semaphore<4> offered_{0};
  std::thread thread_;
};

}  // namespace cordis::sim
