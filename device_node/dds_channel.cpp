// device_node/dds_channel.cpp
#include "device_node/dds_channel.h"

#include "device_node/gesture_wire.h"
#include "node/dds/reader.h"
#include "node/dds/topics.h"
#include "node/dds/writer.h"
#include "node/time.h"

namespace cordis::device {
namespace {

using std::chrono::nanoseconds;

template <class Sent, class Received>
class DdsChannel final : public GestureChannel {
 public:
  DdsChannel(dds::Participant& participant, dds::Topic sent, dds::Topic received,
             std::uint32_t device_id, int strength)
      : writer_(participant, sent, strength),
        reader_(participant, received),
        device_id_(device_id) {}

  bool send(const GestureMessage& sample) noexcept override {
    wire::put(sample, device_id_, sent_);
    return writer_.write(sent_);
  }

  bool receive(GestureMessage& answer, nanoseconds at_most) noexcept override {
    const std::int64_t deadline = node::monotonic_nsec() + at_most.count();
    for (;;) {
      while (reader_.take(received_)) {
        if (received_.device_id() != device_id_) continue;  // another device of the session
        wire::take(received_, answer);
        return true;
      }
      const std::int64_t left = at_most.count() > 0 ? deadline - node::monotonic_nsec() : 0;
      if (left <= 0) return false;
      reader_.wait(nanoseconds(left));
    }
  }

 private:
  dds::Writer<Sent> writer_;
  dds::Reader<Received> reader_;
  std::uint32_t device_id_;
  Sent sent_;
  Received received_;
};

}  // namespace

std::unique_ptr<GestureChannel> make_dds_channel(dds::Participant& participant, Role role,
                                                 std::uint32_t device_id, int strength) {
  if (role == Role::kMass) {
    return std::make_unique<DdsChannel<msg::GesturePositions, msg::GestureForces>>(
        participant, dds::Topic::kPositions, dds::Topic::kForces, device_id, strength);
  }
  return std::make_unique<DdsChannel<msg::GestureForces, msg::GesturePositions>>(
      participant, dds::Topic::kForces, dds::Topic::kPositions, device_id, strength);
}

}  // namespace cordis::device
