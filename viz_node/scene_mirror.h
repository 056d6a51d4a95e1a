// viz_node/scene_mirror.h -- what is known of the scene, handed from the threads of DDS to the
// server.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "viz_node/frame_pace.h"
#include "viz_node/page_text.h"

namespace cordis::viz {

/// A description as pages get it.
struct ShownScene {
  std::uint32_t scene = 0;  ///< +1 per description within the life of viz_node, from 1
  std::string text;         ///< JSON
  std::string topology;     ///< binary
};

/// A frame as it came, numbered by viz_node.
struct ShownFrame {
  std::uint32_t sequence = 0;  ///< +1 per frame within the life of viz_node, from 1
  std::uint32_t scene = 0;
  msg::SceneFrame frame;
};

/// A batch of signals as pages get it.
struct ShownSignals {
  std::uint64_t number = 0;  ///< +1 per batch within the life of viz_node, from 1
  std::string bytes;
};

/// A block of sound as pages get it.
struct ShownSound {
  std::uint64_t number = 0;  ///< +1 per block within the life of viz_node, from 1
  std::string bytes;
};

/// The newest of everything that sim_node and the other nodes said. Its memory is bounded: one
/// scene, one frame, the last batches of signals, half a second of sound, 64 nodes and
/// devices. Any thread may call it; what it hands
/// out never changes and is shared, not copied.
///
/// take() gives back what is wrong with a message that was refused, else an empty string. Refused
/// messages are counted; what comes before the description it belongs to, or after the next one, is
/// passed over in silence.
class SceneMirror {
 public:
  /// @param rate_hz  most frames per second that pages get, > 0
  explicit SceneMirror(double rate_hz) noexcept : pace_(rate_hz) {}

  /// Called from the taking threads, without a lock, when there is something new to send. Set it
  /// before the first take(), and to an empty function after the last.
  void on_change(std::function<void()> call) { changed_ = std::move(call); }

  std::string take(msg::SceneDescription&& description);
  std::string take(msg::SceneFrame&& frame, std::int64_t now_nsec);
  std::string take(msg::SceneSignals&& signals);
  std::string take(msg::SceneSound&& sound);  ///< passed over while no page listens
  std::string take(msg::SceneEvents&& events);
  void take(msg::NodeStatus&& status, std::int64_t now_nsec);
  void take(msg::ControlReply&& reply);
  void take(msg::DeviceDescription&& device);

  std::shared_ptr<const ShownScene> scene() const;  ///< nullptr before the first description
  std::shared_ptr<const ShownFrame> frame()
      const;  ///< newest frame of the present scene; nullptr before its first
  /// The oldest batch kept with a number above `after`; nullptr when there is none.
  std::shared_ptr<const ShownSignals> signals_after(std::uint64_t after) const;
  /// The oldest block kept with a number above `after`, whose numbers have gaps where a slow caller
  /// lost blocks; nullptr when there is none.
  std::shared_ptr<const ShownSound> sound_after(std::uint64_t after) const;
  /// Number of the newest block; 0 before the first.
  std::uint64_t newest_sound() const;
  /// Counts a page that listens to the sound, or one that no longer does.
  void add_listener() noexcept { listeners_.fetch_add(1, std::memory_order_relaxed); }
  void remove_listener() noexcept { listeners_.fetch_sub(1, std::memory_order_relaxed); }
  std::string status(std::int64_t now_nsec) const;  ///< JSON
  MirrorFigures figures() const;

 private:
  std::string refuse(std::string fault);
  bool is_take_played() const;
  /// Encodes a message of the present scene without the lock, then keeps it under the lock.
  template <class Message, class Encode, class Keep>
  std::string take_part(const Message& message, Encode encode, Keep keep_it);
  void keep_signals(std::string bytes);  // the lock is held
  void keep_sound(std::string bytes);    // the lock is held
  void count_gap(const msg::SceneFrame& frame);

  std::function<void()> changed_;
  mutable std::mutex mutex_;
  FramePace pace_;
  std::shared_ptr<const msg::SceneDescription> description_;
  std::shared_ptr<const ShownScene> scene_;
  std::shared_ptr<const ShownFrame> frame_;
  std::deque<std::shared_ptr<const ShownSignals>> signals_;
  std::size_t signals_bytes_ = 0;
  std::deque<std::shared_ptr<const ShownSound>> sound_;
  std::atomic<int> listeners_{0};
  std::map<std::uint32_t, ReportedNode> nodes_;              // by node_id
  std::map<std::uint32_t, msg::DeviceDescription> devices_;  // by device_id
  ReceivedEvents events_;
  ReceivedReplies replies_;
  MirrorFigures figures_;
  std::uint64_t last_frame_number_ = 0;  // of sim_node, within the present epoch
  std::uint32_t scene_count_ = 0;
  std::uint32_t frame_count_ = 0;
  std::uint64_t batch_count_ = 0;
  std::uint64_t sound_count_ = 0;
};

}  // namespace cordis::viz
