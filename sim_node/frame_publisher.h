// sim_node/frame_publisher.h -- tells the display, without ever holding the loop.
#pragma once

#include <atomic>
#include <cstdint>
#include <semaphore>
#include <thread>

#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/run/frame_store.h"

namespace cordis::sim {

/// Publishes scene/frame, scene/signals and scene/events from a thread of its own.
///
/// The loop fills one of the two buffers of a store, and hands it over when a frame is due and the
/// thread has finished with the last one. When it has not, the frame is left out and the rows
/// and events stay for the next; those beyond the buffer are counted as dropped. The loop's side is
/// O(MATs) per frame, takes no lock and allocates nothing.
class FramePublisher {
 public:
  FramePublisher(dds::Participant& participant, std::uint64_t epoch);
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Loop: a frame is due. @return false when it was left out because the thread is still busy.
  /// The store must live until is_busy() is false again.
  bool offer(FrameStore& store, const engine::World& world, double simulated_s,
             std::int64_t now_nsec, std::int64_t action_nsec = 0) noexcept;

  /// True if the thread uses the store that was offered last.
  bool is_busy() const noexcept { return busy_.load(std::memory_order_acquire); }

  /// Loop without real time: waits until the thread has finished with the last frame, so that none
  /// is left out.
  void wait_until_free() const noexcept { busy_.wait(true, std::memory_order_acquire); }

  std::uint64_t frames_left_out() const noexcept {
    return frames_left_out_.load(std::memory_order_relaxed);
  }
  /// Frames, batches of signals and batches of events that DDS did not take.
  std::uint64_t unwritten() const noexcept { return unwritten_.load(std::memory_order_relaxed); }
  std::uint64_t lost_events() const noexcept {
    return lost_events_.load(std::memory_order_relaxed);
  }  ///< in the whole run

 private:
  void loop();
  void count(bool written) noexcept;
  void publish_frame(const FrameShape& shape, const FrameBuffer& buffer);
  void publish_signals(const FrameShape& shape, const FrameBuffer& buffer);
  void publish_events(const FrameShape& shape, const EventRoom& room);

  dds::Writer<msg::SceneFrame> frame_writer_;
  dds::Writer<msg::SceneSignals> signal_writer_;
  dds::Writer<msg::SceneEvents> event_writer_;
  msg::SceneFrame frame_;
  msg::SceneSignals signals_;
  msg::SceneEvents events_;

  const FrameStore* offered_ = nullptr;  // the thread's while busy_
  std::atomic<bool> busy_{false};
  std::atomic<std::uint64_t> frames_left_out_{0};
  std::atomic<std::uint64_t> unwritten_{0};
  std::atomic<std::uint64_t> lost_events_{0};
  std::atomic<bool> ending_{false};
  std::counting_semaphore<4> wake_{0};
  std::thread thread_;
};

}  // namespace cordis::sim
