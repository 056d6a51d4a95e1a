// viz_node/web/send_queue.h -- what a page is sent, and when.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>

#include "node/time.h"
#include "viz_node/frame_encoder.h"
#include "viz_node/web/flow_credit.h"
#include "viz_node/web/server_state.h"

namespace cordis::viz {

/// What one page has not been sent yet, the most due first.
class SendQueue {
 public:
  struct Message {
    bool is_text = false;
    std::array<asio::const_buffer, 7> parts;  ///< stay until next() is called again
  };

  /// @param page         number of the page
  /// @param may_command  what its hello says
  /// @param every        of so many frames it gets one
  SendQueue(ServerState& state, std::uint32_t page, bool may_command, std::uint32_t every)
      : state_(state),
        page_(page),
        hello_(may_command ? state.hello : state.hello_view_only),
        credit_(every) {}
  ~SendQueue() { listen(false); }
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;

  /// The next thing that is due, which counts as sent; nothing when the page has it all.
  std::optional<Message> next() {
    if (!std::exchange(hello_sent_, true)) return text(hello_);
    if (auto scene = next_of_scene()) return scene;
    sound_first_ =
        !sound_first_;  // waits for one other message at most, and holds up none for long
    if (sound_first_) {
      if (auto sound = next_sound()) return sound;
    }
    if (auto other = next_other()) return other;
    return sound_first_ ? std::nullopt : next_sound();
  }

  FlowCredit& credit() noexcept { return credit_; }

  /// Starts or stops sending blocks of sound to the page.
  void listen(bool listens) {
    if (std::exchange(listens_, listens) == listens) return;
    if (listens) {
      state_.mirror.add_listener();
      sound_number_ = state_.mirror.newest_sound();
    } else {
      state_.mirror.remove_listener();
    }
  }

 private:
  static Message text(const std::string& text) { return {true, {asio::buffer(text)}}; }

  std::optional<Message> next_of_scene() {
    if (topology_due_ != nullptr) {
      kept_scene_ = std::exchange(topology_due_, nullptr);
      return Message{false, {asio::buffer(kept_scene_->topology)}};
    }
    auto scene = state_.mirror.scene();
    if (scene == nullptr || scene->scene == scene_) return {};
    scene_ = scene->scene;
    credit_.reset();
    kept_scene_ = topology_due_ = std::move(scene);
    return text(kept_scene_->text);
  }

  std::optional<Message> next_other() {
    if (auto status = next_status()) return status;
    if (auto pointers = next_pointers()) return pointers;
    frame_first_ = !frame_first_;  // in turn: on a slow line neither starves the other
    if (auto first = frame_first_ ? next_frame() : next_signals()) return first;
    return frame_first_ ? next_signals() : next_frame();
  }

  std::optional<Message> next_status() {
    if (state_.status == nullptr || status_number_ == state_.status_number) return {};
    status_number_ = state_.status_number;
    kept_status_ = state_.status;
    return text(*kept_status_);
  }

  std::optional<Message> next_pointers() {
    const std::uint64_t version = state_.pointers.version();
    if (version == std::exchange(pointers_version_, version)) return {};
    kept_pointers_ = state_.pointers.text(page_, node::monotonic_nsec());
    return text(kept_pointers_);
  }

  std::optional<Message> next_signals() {
    kept_signals_ = state_.mirror.signals_after(signals_number_);
    if (kept_signals_ == nullptr) return {};
    signals_number_ = kept_signals_->number;
    return Message{false, {asio::buffer(kept_signals_->bytes)}};
  }

  /// Every block in its order. A page that is slower than half a second loses the oldest, which it
  /// sees by the numbers of the steps.
  std::optional<Message> next_sound() {
    if (!listens_) return {};
    kept_sound_ = state_.mirror.sound_after(sound_number_);
    if (kept_sound_ == nullptr) return {};
    sound_number_ = kept_sound_->number;
    return Message{false, {asio::buffer(kept_sound_->bytes)}};
  }

  std::optional<Message> next_frame() {
    kept_frame_ = state_.mirror.frame();
    if (kept_frame_ == nullptr || kept_frame_->scene != scene_) return {};
    const std::int64_t now_nsec = node::monotonic_nsec();
    if (!credit_.may_send(kept_frame_->sequence, now_nsec)) return {};
    const msg::SceneFrame& frame = kept_frame_->frame;
    const bool played = frame.action_time_nsec() != 0;
    credit_.sent(kept_frame_->sequence, played ? frame.action_time_nsec() : frame.time_nsec(),
                 now_nsec);
    header_ = encode({.sequence = kept_frame_->sequence,
                      .scene = kept_frame_->scene,
                      .frame = frame.frame(),
                      .step = frame.step(),
                      .taken_nsec = frame.time_nsec(),
                      .sent_nsec = now_nsec,
                      .simulated_s = frame.simulated_s(),
                      .mat_count = static_cast<std::uint32_t>(frame.position_m().size() / 3),
                      .link_state_count = static_cast<std::uint32_t>(frame.link_state().size()),
                      .dropped = credit_.dropped(),
                      .bond_count = static_cast<std::uint32_t>(frame.bond_state().size()),
                      .bonds_left_out = frame.bonds_left_out(),
                      .set_count = static_cast<std::uint32_t>(frame.bond_count().size()),
                      .port_count = static_cast<std::uint32_t>(frame.port_force_n().size() / 3)});
    return Message{
        false,
        {asio::buffer(header_), asio::buffer(frame.position_m()), asio::buffer(frame.bond_ends()),
         asio::buffer(frame.bond_count()), asio::buffer(frame.port_force_n()),
         asio::buffer(frame.link_state()), asio::buffer(frame.bond_state())}};
  }

  ServerState& state_;
  std::uint32_t page_;
  const std::string& hello_;
  std::uint64_t pointers_version_ = 0;
  FlowCredit credit_;
  bool hello_sent_ = false;
  bool frame_first_ = false;
  bool sound_first_ = false;
  std::uint32_t scene_ = 0;
  std::uint64_t status_number_ = 0;
  std::uint64_t signals_number_ = 0;
  bool listens_ = false;
  std::uint64_t sound_number_ = 0;
  std::shared_ptr<const ShownScene> topology_due_;
  // What the message on its way is made of.
  std::shared_ptr<const ShownScene> kept_scene_;
  std::shared_ptr<const std::string> kept_status_;
  std::string kept_pointers_;
  std::shared_ptr<const ShownSignals> kept_signals_;
  std::shared_ptr<const ShownSound> kept_sound_;
  std::shared_ptr<const ShownFrame> kept_frame_;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
};

}  // namespace cordis::viz
