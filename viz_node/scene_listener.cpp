// viz_node/scene_listener.cpp
#include "viz_node/scene_listener.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "node/dds/reader.h"
#include "node/repeated_event.h"
#include "node/time.h"

namespace cordis::viz {
namespace {

constexpr auto kLongestWait = std::chrono::seconds(1);

/// The clock of another host says nothing here: such a frame is as old as its stay on this one.
void take_time_of_arrival(msg::SceneFrame& frame) noexcept {
  frame.time_nsec(node::monotonic_nsec());
  frame.action_time_nsec(0);
}

/// A reader and the thread that follows it.
template <class Message>
class Follower {
 public:
  Follower(dds::Participant& participant, dds::Topic topic)
      : reader_(participant, topic),
        refusals_(std::string("refused other messages of ") +
                  dds::qos_of(topic, false, false).name) {}

  ~Follower() {
    ending_ = true;
    reader_.interrupt();
    if (thread_.joinable()) thread_.join();
  }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// @param use  takes a message and gives back what is wrong with it, or an empty string
  template <class Use>
  void follow(Use use) {
    thread_ = std::thread([this, use] {
      Message message;
      while (!ending_) {
        const bool any = reader_.wait(kLongestWait);
        refusals_.report(node::monotonic_nsec());
        if (!any) continue;
        while (!ending_ && reader_.take(message)) {
          if constexpr (std::is_same_v<Message, msg::SceneFrame>) {
            if (!reader_.is_of_this_host()) take_time_of_arrival(message);
          }
          const std::string fault = fault_of(message, use);
          message = Message();
          if (!fault.empty() && refusals_.record(node::monotonic_nsec()))
            spdlog::warn("refused {}", fault);
        }
      }
    });
  }

 private:
  /// What `use` says is wrong with the message; also when there is no memory for it.
  template <class Use>
  static std::string fault_of(Message& message, const Use& use) {
    try {
      return use(std::move(message));
    } catch (const std::exception& error) {
      return std::string("a message of another node: ") + error.what();
    }
  }

  dds::Reader<Message> reader_;
  node::RepeatedEvent refusals_;  // of the thread
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace

struct SceneListener::Impl {
  explicit Impl(dds::Participant& participant)
      : description(participant, dds::Topic::kDescription),
        frame(participant, dds::Topic::kFrame),
        signals(participant, dds::Topic::kSignals),
        sound(participant, dds::Topic::kSound),
        events(participant, dds::Topic::kEvents),
        status(participant, dds::Topic::kStatus),
        reply(participant, dds::Topic::kReply),
        pointer(participant, dds::Topic::kPointerState),
        device(participant, dds::Topic::kDevice) {}

  Follower<msg::SceneDescription> description;
  Follower<msg::SceneFrame> frame;
  Follower<msg::SceneSignals> signals;
  Follower<msg::SceneSound> sound;
  Follower<msg::SceneEvents> events;
  Follower<msg::NodeStatus> status;
  Follower<msg::ControlReply> reply;
  Follower<msg::PointerState> pointer;
  Follower<msg::DeviceDescription> device;
};

SceneListener::SceneListener(dds::Participant& participant, SceneMirror& mirror,
                             CommandRelay& relay, PointerDesk& pointers)
    : impl_(std::make_unique<Impl>(participant)) {
  impl_->description.follow([&mirror, &pointers](msg::SceneDescription&& message) {
    const std::vector<msg::PortDescription> ports = message.ports();
    const std::vector<msg::PortFrame> frames = message.port_frames();
    std::string fault = mirror.take(std::move(message));
    if (fault.empty()) pointers.describe(ports, frames, node::monotonic_nsec());
    return fault;
  });
  impl_->frame.follow([&mirror](msg::SceneFrame&& message) {
    return mirror.take(std::move(message), node::monotonic_nsec());
  });
  impl_->signals.follow(
      [&mirror](msg::SceneSignals&& message) { return mirror.take(std::move(message)); });
  impl_->sound.follow(
      [&mirror](msg::SceneSound&& message) { return mirror.take(std::move(message)); });
  impl_->events.follow(
      [&mirror](msg::SceneEvents&& message) { return mirror.take(std::move(message)); });
  impl_->status.follow([&mirror, &relay](msg::NodeStatus&& message) {
    relay.take(message);
    mirror.take(std::move(message), node::monotonic_nsec());
    return std::string();
  });
  impl_->reply.follow([&mirror, &relay](msg::ControlReply&& message) {
    if (relay.is_mine(message)) mirror.take(std::move(message));
    return std::string();
  });
  impl_->pointer.follow([&pointers](msg::PointerState&& message) {
    pointers.take(message, node::monotonic_nsec());
    return std::string();
  });
  impl_->device.follow([&mirror](msg::DeviceDescription&& message) {
    mirror.take(std::move(message));
    return std::string();
  });
}

SceneListener::~SceneListener() = default;

}  // namespace cordis::viz
