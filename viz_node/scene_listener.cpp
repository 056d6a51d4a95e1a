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
#include "node/dds/socket_buffer.h"
#include "node/repeated_event.h"
#include "node/time.h"
#include "viz_node/frame_size.h"

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
  Follower(dds::Participant& participant, dds::Topic topic,
           dds::Repair repair = dds::Repair::kOfTopic)
      : reader_(participant, topic, nullptr, repair),
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

/// What comes 25 times a second: a lost one is replaced by the next.
struct Samples {
  Samples(dds::Participant& participant, SceneMirror& mirror, dds::Repair asked)
      : repair(asked),
        frame(participant, dds::Topic::kFrame, asked),
        signals(participant, dds::Topic::kSignals, asked) {
    frame.follow([&mirror](msg::SceneFrame&& message) {
      return mirror.take(std::move(message), node::monotonic_nsec());
    });
    signals.follow(
        [&mirror](msg::SceneSignals&& message) { return mirror.take(std::move(message)); });
  }

  const dds::Repair repair;
  Follower<msg::SceneFrame> frame;
  Follower<msg::SceneSignals> signals;
};

}  // namespace

struct SceneListener::Impl {
  explicit Impl(dds::Participant& joined)
      : participant(joined),
        description(participant, dds::Topic::kDescription),
        sound(participant, dds::Topic::kSound),
        events(participant, dds::Topic::kEvents),
        status(participant, dds::Topic::kStatus),
        reply(participant, dds::Topic::kReply),
        pointer(participant, dds::Topic::kPointerState),
        device(participant, dds::Topic::kDevice) {}

  /// Repair of lost parts costs a viz_node of 10,000 balls a quarter of its processor time.
  dds::Repair repair_of(const msg::SceneDescription& scene) const noexcept {
    const bool is_safe = participant.config().network.is_loopback() &&
                         arrives_whole(largest_frame_bytes(scene), socket_bytes);
    return is_safe ? dds::Repair::kNone : dds::Repair::kOfTopic;
  }

  /// Reads frames and signals from now on. In the thread of descriptions.
  void read_samples(SceneMirror& mirror, dds::Repair repair) {
    if (samples == nullptr || samples->repair != repair)
      samples = std::make_unique<Samples>(participant, mirror, repair);
  }

  dds::Participant& participant;
  const std::size_t socket_bytes = dds::granted_bytes(dds::SocketBuffer::kReceive);
  std::unique_ptr<Samples> samples;  // outlives the thread of descriptions, which makes it
  Follower<msg::SceneDescription> description;
  Follower<msg::SceneSound> sound;
  Follower<msg::SceneEvents> events;
  Follower<msg::NodeStatus> status;
  Follower<msg::ControlReply> reply;
  Follower<msg::PointerState> pointer;
  Follower<msg::DeviceDescription> device;
};

SceneListener::SceneListener(dds::Participant& participant, SceneMirror& mirror,
                             CommandRelay& relay, PointerServer& pointers)
    : impl_(std::make_unique<Impl>(participant)) {
  impl_->description.follow([this, &mirror, &pointers](msg::SceneDescription&& message) {
    const std::vector<msg::PortDescription> ports = message.ports();
    const std::vector<msg::PortFrame> frames = message.port_frames();
    const dds::Repair repair = impl_->repair_of(message);
    std::string fault = mirror.take(std::move(message));
    if (!fault.empty()) return fault;
    pointers.describe(ports, frames, node::monotonic_nsec());
    impl_->read_samples(mirror, repair);
    return fault;
  });
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
