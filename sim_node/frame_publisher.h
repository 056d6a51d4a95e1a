// sim_node/frame_publisher.h -- publishes to the display, without ever holding the loop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <semaphore>
#include <string>
#include <thread>

#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/input_publisher.h"
#include "sim_node/run/frame_store.h"

namespace cordis::sim {

/// Publishes scene/frame, scene/signals, scene/events and, through an InputPublisher, scene/inputs
/// from a thread of its own.
///
/// The loop fills one of the two buffers of a store, and hands it over when a frame is due and the
/// thread has finished with the last one. When it has not, the frame is left out and the rows
/// and events stay for the next; those beyond the buffer are counted as dropped. The loop's side is
/// O(MATs) per frame, takes no lock and allocates nothing.
class FramePublisher {
 public:
  /// @param inputs  published by the same thread; must outlive this
  FramePublisher(dds::Participant& participant, std::uint64_t epoch, InputPublisher& inputs);
  ~FramePublisher();
  FramePublisher(const FramePublisher&) = delete;
  FramePublisher& operator=(const FramePublisher&) = delete;

  /// Before the loop begins: waits until a node reads scene/signals, at most so long or until a stop
  /// is asked for. @param is_paced  without real time: that node, when it reads, then gets every
  /// batch, however fast the scene is. A reader that has stopped, whichever it is, holds the scene
  /// once for 1 s, then for 0.1 s in eight batches. @return whether it reads
  bool wait_for_signal_reader(const std::string& node, bool is_paced,
                              std::chrono::milliseconds at_most);

  /// Before the loop begins, without real time: a recorder gets every frame. Each waits until readers
  /// that ask for all have the one before. One that has stopped holds the scene once for 1 s, then for
  /// 0.1 s in eight frames.
  void keep_every_frame() noexcept { keeps_frames_ = true; }

  /// True if a node reads scene/signals.
  bool has_signal_reader(const std::string& node) const {
    return signal_writer_.has_reader_of(node);
  }

  /// Loop: a frame is due. @return false when it was left out because the thread is still busy.
  /// The store must live until is_busy() is false again.
  bool submit(FrameStore& store, const engine::World& world, double simulated_s,
              std::int64_t now_nsec, std::int64_t action_nsec = 0) noexcept;

  /// Loop: the inputs are to be published before the next frame is due. Real time: takes no lock.
  void wake_early() noexcept;

  /// True if the thread uses the store that was submitted last.
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
  template <class Writer>
  static void wait_for_readers(Writer& writer, bool& has_stopped);
  void write_signals();
  void write_frame();
  void publish_frame(const FrameShape& shape, const FrameBuffer& buffer);
  void publish_signals(const FrameShape& shape, const FrameBuffer& buffer);
  void publish_step_signals(const FrameShape& shape, const FrameBuffer& buffer);
  void publish_events(const FrameShape& shape, const EventRoom& room);

  InputPublisher& inputs_;
  dds::Writer<msg::SceneFrame> frame_writer_;
  dds::Writer<msg::SceneSignals> signal_writer_;
  dds::Writer<msg::SceneEvents> event_writer_;
  msg::SceneFrame frame_;
  msg::SceneSignals signals_;
  msg::SceneEvents events_;

  bool is_paced_ = false;                  // set before the first frame
  bool has_stopped_reader_ = false;        // of scene/signals, which takes nothing
  bool keeps_frames_ = false;              // set before the first frame
  bool has_stopped_watcher_ = false;       // of scene/frame, which takes nothing
  const FrameStore* submitted_ = nullptr;  // the thread's while busy_
  std::atomic<bool> busy_{false};
  std::atomic<std::uint64_t> frames_left_out_{0};
  std::atomic<std::uint64_t> unwritten_{0};
  std::atomic<std::uint64_t> lost_events_{0};
  std::atomic<bool> woken_early_{false};
  std::atomic<bool> ending_{false};
  std::counting_semaphore<4> wake_{0};
  std::thread thread_;
};

}  // namespace cordis::sim
