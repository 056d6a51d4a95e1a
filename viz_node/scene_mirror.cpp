// viz_node/scene_mirror.cpp
#include "viz_node/scene_mirror.h"

#include <algorithm>
#include <utility>

#include "node/status_words.h"
#include "viz_node/frame_encoder.h"
#include "viz_node/scene_check.h"

namespace cordis::viz {
namespace {

// A page that comes late finds this much of the signals: 64 batches of 25 Hz are two and a half
// seconds.
constexpr std::size_t kBatchesKept = 64;
constexpr std::size_t kBatchBytesKept = 16u << 20;
constexpr std::size_t kSoundKept = 64;  // blocks of 8 ms
constexpr std::size_t kMaxNodes = 64;
constexpr std::uint64_t kMaxOlder = 64;      // versions of a scene that may come late
constexpr std::uint64_t kMaxLost = 100'000;  // frames between two that came: an hour of 25 Hz

/// True if a message belongs to the scene that sim_node played before, or to one whose description
/// has not come yet: for a moment around a change of scene or a restart, both come.
template <class Message>
bool is_of_another_scene(const Message& message, const msg::SceneDescription& description) {
  return message.epoch() != description.epoch() || message.version() != description.version();
}

}  // namespace

/// A take may jump back to the scene that was played before; the lock is held.
bool SceneMirror::is_take_played() const {
  return std::ranges::any_of(nodes_, [](const auto& entry) {
    const msg::NodeStatus& status = entry.second.status;
    return status.kind() == msg::KIND_PLAYER && !node::has_ended(status.phase());
  });
}

std::string SceneMirror::refuse(std::string fault) {
  const std::lock_guard lock(mutex_);
  ++figures_.refused;
  return fault;
}

std::string SceneMirror::take(msg::SceneDescription&& description) {
  std::string fault = fault_of(description);
  if (!fault.empty()) return refuse(std::move(fault));
  auto shown = std::make_shared<ShownScene>();
  shown->scene = ++scene_count_;  // only the thread of descriptions comes here
  shown->text = description_text(description, shown->scene);
  shown->topology = encode_topology(description, shown->scene);
  {
    const std::lock_guard lock(mutex_);
    const bool same_epoch = description_ != nullptr && description_->epoch() == description.epoch();
    // Late, and not one of a number that no scene could have reached.
    const std::uint64_t older = same_epoch ? description_->version() - description.version() : 0;
    if (older > 0 && older <= kMaxOlder && !is_take_played()) return {};
    last_frame_number_ = 0;  // frames before a description are passed over, not lost
    figures_.frame_rate_hz = description.frame_rate_hz();
    description_ = std::make_shared<const msg::SceneDescription>(std::move(description));
    scene_ = std::move(shown);
    frame_.reset();
    signals_.clear();
    signals_bytes_ = 0;
    sound_.clear();
    events_ = {};
  }
  if (changed_) changed_();
  return {};
}

void SceneMirror::count_gap(const msg::SceneFrame& frame) {
  const std::uint64_t last = std::exchange(last_frame_number_, frame.frame());
  if (last == 0 || frame.frame() <= last) return;
  // A jump beyond what may be lost is no count: numbers are as others wrote them.
  const std::uint64_t step = frame.frame() - last;
  if (step <= kMaxLost) figures_.lost += step - 1;
}

std::string SceneMirror::take(msg::SceneFrame&& frame, std::int64_t now_nsec) {
  std::shared_ptr<const msg::SceneDescription> description;
  {
    const std::lock_guard lock(mutex_);
    description = description_;
  }
  if (description == nullptr || is_of_another_scene(frame, *description)) return {};
  std::string fault = fault_of(frame, *description);
  if (!fault.empty()) return refuse(std::move(fault));
  // Times are subtracted from the clock, whatever another process wrote.
  frame.time_nsec(std::max<std::int64_t>(frame.time_nsec(), 0));
  frame.action_time_nsec(std::max<std::int64_t>(frame.action_time_nsec(), 0));
  auto shown = std::make_shared<ShownFrame>();
  {
    const std::lock_guard lock(mutex_);
    if (description != description_) return {};  // described again meanwhile
    count_gap(frame);
    figures_.last_frame_nsec = now_nsec;
    if (!pace_.lets_through(now_nsec)) return {};
    ++figures_.frames;
    shown->sequence = ++frame_count_;
    shown->scene = scene_->scene;
    shown->frame = std::move(frame);
    frame_ = std::move(shown);
  }
  if (changed_) changed_();
  return {};
}

void SceneMirror::keep_signals(std::string bytes) {
  signals_bytes_ += bytes.size();
  signals_.push_back(
      std::make_shared<const ShownSignals>(ShownSignals{++batch_count_, std::move(bytes)}));
  while (signals_.size() > kBatchesKept || signals_bytes_ > kBatchBytesKept) {
    signals_bytes_ -= signals_.front()->bytes.size();
    signals_.pop_front();
  }
}

void SceneMirror::keep_sound(std::string bytes) {
  sound_.push_back(
      std::make_shared<const ShownSound>(ShownSound{++sound_count_, std::move(bytes)}));
  if (sound_.size() > kSoundKept) sound_.pop_front();
}

template <class Message, class Encode, class Keep>
std::string SceneMirror::take_part(const Message& message, Encode encode, Keep keep_it) {
  std::shared_ptr<const msg::SceneDescription> description;
  std::uint32_t scene = 0;
  {
    const std::lock_guard lock(mutex_);
    if (description_ == nullptr) return {};
    description = description_;
    scene = scene_->scene;
  }
  if (is_of_another_scene(message, *description)) return {};
  std::string fault = fault_of(message, *description);
  if (!fault.empty()) return refuse(std::move(fault));
  std::string bytes = encode(scene, *description);
  {
    const std::lock_guard lock(mutex_);
    if (description != description_) return {};  // described again meanwhile
    keep_it(std::move(bytes));
  }
  if (changed_) changed_();
  return {};
}

std::string SceneMirror::take(msg::SceneSignals&& signals) {
  // A plot has a point per gesture; what is taken at every step stands there as well.
  if (signals.rate() != msg::RATE_GESTURE) return {};
  return take_part(
      signals,
      [&](std::uint32_t scene, const msg::SceneDescription& description) {
        return encode_signals(signals, scene, description.step_rate_hz());
      },
      [this](std::string bytes) { keep_signals(std::move(bytes)); });
}

std::string SceneMirror::take(msg::SceneSound&& sound) {
  if (listeners_.load(std::memory_order_relaxed) == 0) return {};
  return take_part(
      sound,
      [&](std::uint32_t scene, const msg::SceneDescription&) { return encode_sound(sound, scene); },
      [this](std::string bytes) { keep_sound(std::move(bytes)); });
}

std::string SceneMirror::take(msg::SceneEvents&& events) {
  const std::lock_guard lock(mutex_);
  if (description_ == nullptr) return {};
  if (is_of_another_scene(events, *description_)) return {};
  std::string fault = fault_of(events, *description_);
  if (!fault.empty()) {
    ++figures_.refused;
    return fault;
  }
  events_.total += events.event().size();
  events_.lost += events.lost();
  for (const auto& event : events.event()) {
    events_.newest.push_back(event);
    if (events_.newest.size() > kEventsShown) events_.newest.pop_front();
  }
  return {};
}

void SceneMirror::take(msg::NodeStatus&& status, std::int64_t now_nsec) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t node_id = status.node_id();
  if (nodes_.size() >= kMaxNodes && !nodes_.contains(node_id)) {
    nodes_.erase(std::ranges::min_element(
        nodes_, {}, [](const auto& entry) { return entry.second.received_nsec; }));
  }
  nodes_[node_id] = {std::move(status), now_nsec};
}

void SceneMirror::take(msg::DeviceDescription&& device) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t device_id = device.device_id();
  if (devices_.size() >= kMaxNodes && !devices_.contains(device_id)) return;
  devices_[device_id] = std::move(device);
}

void SceneMirror::take(msg::ControlReply&& reply) {
  const std::lock_guard lock(mutex_);
  replies_.push_back(std::move(reply));
  if (replies_.size() > kRepliesShown) replies_.pop_front();
}

std::shared_ptr<const ShownScene> SceneMirror::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

std::shared_ptr<const ShownFrame> SceneMirror::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::shared_ptr<const ShownSignals> SceneMirror::signals_after(std::uint64_t after) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::upper_bound(signals_, after, {},
                                              [](const auto& batch) { return batch->number; });
  return found == signals_.end() ? nullptr : *found;
}

std::shared_ptr<const ShownSound> SceneMirror::sound_after(std::uint64_t after) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::upper_bound(sound_, after, {}, [](const auto& block) { return block->number; });
  return found == sound_.end() ? nullptr : *found;
}

std::uint64_t SceneMirror::newest_sound() const {
  const std::lock_guard lock(mutex_);
  return sound_count_;
}

std::string SceneMirror::status(std::int64_t now_nsec) const {
  std::vector<ReportedNode> nodes;
  std::vector<msg::DeviceDescription> devices;
  ReceivedEvents events;
  ReceivedReplies replies;
  MirrorFigures figures;
  std::uint32_t scene = 0;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, node] : nodes_) nodes.push_back(node);
    for (const auto& [id, device] : devices_) devices.push_back(device);
    events = events_;
    replies = replies_;
    figures = figures_;
    if (scene_ != nullptr) scene = scene_->scene;
  }
  return status_text(nodes, devices, events, replies, figures, scene, now_nsec);
}

MirrorFigures SceneMirror::figures() const {
  const std::lock_guard lock(mutex_);
  return figures_;
}

}  // namespace cordis::viz
