// viz_node/web/server_client.h -- what a page is sent, and when.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <spdlog/spdlog.h>

#include "node/time.h"
#include "viz_node/frame_encoder.h"
#include "viz_node/page_text.h"
#include "viz_node/web/client_credit.h"
#include "viz_node/web/server_hub.h"

namespace cordis::viz {

inline constexpr auto kSilenceTimeout = std::chrono::seconds(30);
inline constexpr std::size_t kLongestFromClient = 1024;  // [bytes]

/// One page. Sends one message at a time, whatever is most due; reads acknowledgements and
/// commands.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(beast::tcp_stream&& stream, Seat&& seat, Hub& hub)
      : stream_(std::move(stream)), seat_(std::move(seat)), hub_(hub) {}
  ~Client() {
    hub_.clients.erase(this);
    if (joined_) spdlog::debug("a page left, {} frames passed it by", credit_.dropped());
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{kRequestTimeout, kSilenceTimeout,
                                                       /*keep_alive_pings=*/true});
    stream_.read_message_max(kLongestFromClient);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return;
      self->joined_ = true;
      self->hub_.clients.insert(self.get());
      self->read();
      self->pump();
    });
  }

  /// Sends the next thing that is due, unless a message is still on its way into the socket.
  void pump() {
    if (writing_) return;
    if (!hello_sent_) {
      hello_sent_ = true;
      return send_text(hub_.hello);
    }
    if (send_scene() || send_status() || send_signals()) return;
    send_frame();
  }

 private:
  bool send_scene() {
    if (topology_due_ != nullptr) {
      kept_scene_ = std::exchange(topology_due_, nullptr);
      send_binary({asio::buffer(kept_scene_->topology)});
      return true;
    }
    auto scene = hub_.mirror.scene();
    if (scene == nullptr || scene->scene == scene_) return false;
    scene_ = scene->scene;
    kept_scene_ = topology_due_ = std::move(scene);
    send_text(kept_scene_->text);
    return true;
  }

  bool send_status() {
    if (hub_.status == nullptr || status_number_ == hub_.status_number) return false;
    status_number_ = hub_.status_number;
    kept_status_ = hub_.status;
    send_text(*kept_status_);
    return true;
  }

  bool send_signals() {
    kept_signals_ = hub_.mirror.signals_after(signals_number_);
    if (kept_signals_ == nullptr) return false;
    signals_number_ = kept_signals_->number;
    send_binary({asio::buffer(kept_signals_->bytes)});
    return true;
  }

  void send_frame() {
    kept_frame_ = hub_.mirror.frame();
    if (kept_frame_ == nullptr || kept_frame_->scene != scene_) return;
    if (!credit_.may_send(kept_frame_->sequence)) return;
    const msg::SceneFrame& frame = kept_frame_->frame;
    const bool played = frame.action_time_nsec() != 0;
    credit_.sent(kept_frame_->sequence, played ? frame.action_time_nsec() : frame.time_nsec());
    header_ = encode({.sequence = kept_frame_->sequence,
                      .scene = kept_frame_->scene,
                      .frame = frame.frame(),
                      .step = frame.step(),
                      .taken_nsec = frame.time_nsec(),
                      .sent_nsec = node::monotonic_nsec(),
                      .simulated_s = frame.simulated_s(),
                      .mat_count = static_cast<std::uint32_t>(frame.position_m().size() / 3),
                      .link_state_count = static_cast<std::uint32_t>(frame.link_state().size()),
                      .dropped = credit_.dropped()});
    send_binary({asio::buffer(header_), asio::buffer(frame.position_m()),
                 asio::buffer(frame.link_state())});
  }

  void send_text(const std::string& text) {
    stream_.text(true);
    send({asio::buffer(text)});
  }

  void send_binary(const std::array<asio::const_buffer, 3>& parts) {
    stream_.binary(true);
    send(parts);
  }

  void send(const std::array<asio::const_buffer, 3>& parts) {
    writing_ = true;
    stream_.async_write(parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
      self->writing_ = false;
      if (error) return self->leave();
      self->pump();
    });
  }

  void read() {
    stream_.async_read(incoming_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->leave();
      self->on_message();
      self->read();
    });
  }

  void on_message() {
    const std::string text = beast::buffers_to_string(incoming_.data());
    incoming_.consume(incoming_.size());
    const auto word = read_acknowledgement(text);
    if (!word) {
      if (const auto command = read_page_command(text)) hub_.obey(*command);
      return;
    }
    const auto taken_nsec = credit_.acknowledge(word->sequence);
    if (taken_nsec && word->drawn) {
      const std::lock_guard lock(hub_.latency_mutex);
      hub_.latency.record(node::monotonic_nsec() - *taken_nsec);
    }
    pump();
  }

  void leave() {
    hub_.clients.erase(this);
    beast::get_lowest_layer(stream_).close();
  }

  websocket::stream<beast::tcp_stream> stream_;
  Seat seat_;
  Hub& hub_;
  ClientCredit credit_;
  beast::flat_buffer incoming_;
  bool joined_ = false;
  bool writing_ = false;
  bool hello_sent_ = false;
  std::uint32_t scene_ = 0;
  std::uint64_t status_number_ = 0;
  std::uint64_t signals_number_ = 0;
  std::shared_ptr<const ShownScene> topology_due_;
  // What the message on its way is made of.
  std::shared_ptr<const ShownScene> kept_scene_;
  std::shared_ptr<const std::string> kept_status_;
  std::shared_ptr<const ShownSignals> kept_signals_;
  std::shared_ptr<const ShownFrame> kept_frame_;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
};

}  // namespace cordis::viz
