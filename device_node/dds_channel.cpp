// device_node/dds_channel.cpp
#include "device_node/dds_channel.h"

#include <algorithm>

#include "idl/gesture.h"
#include "node/dds/reader.h"
#include "node/dds/topics.h"
#include "node/dds/writer.h"
#include "node/time.h"

namespace cordis::device {
namespace {

using std::chrono::nanoseconds;

AxisValues& values_of(msg::GesturePositions& message) {
  return message.position_m();
}
AxisValues& values_of(msg::GestureForces& message) {
  return message.force_n();
}

template <class Sent, class Received>
class DdsChannel final : public GestureChannel {
 public:
  DdsChannel(dds::Participant& participant, dds::Topic sent, dds::Topic received,
             std::uint32_t device_id, int strength)
      : writer_(participant, sent, strength),
        reader_(participant, received),
        device_id_(device_id) {}

  bool send(const GestureMessage& sample) noexcept override {
    sent_.device_id(device_id_);
    sent_.run(sample.run);
    sent_.sample(sample.sample);
    sent_.answered_run(sample.answered_run);
    sent_.answered_sample(sample.answered_sample);
    sent_.answered_time_nsec(sample.answered_time_nsec);
    sent_.time_nsec(sample.time_nsec);
    sent_.axis_count(sample.axis_count);
    values_of(sent_) = sample.value;
    return writer_.write(sent_);
  }

  bool receive(GestureMessage& answer, nanoseconds at_most) noexcept override {
    const std::int64_t deadline = node::monotonic_nsec() + at_most.count();
    for (;;) {
      while (reader_.take(received_)) {
        if (received_.device_id() != device_id_) continue;  // another device of the session
        translate(answer);
        return true;
      }
      const std::int64_t left = at_most.count() > 0 ? deadline - node::monotonic_nsec() : 0;
      if (left <= 0) return false;
      reader_.wait(nanoseconds(left));
    }
  }

 private:
  void translate(GestureMessage& answer) noexcept {
    answer.run = received_.run();
    answer.sample = received_.sample();
    answer.answered_run = received_.answered_run();
    answer.answered_sample = received_.answered_sample();
    answer.answered_time_nsec = received_.answered_time_nsec();
    answer.time_nsec = received_.time_nsec();
    answer.axis_count = received_.axis_count();
    answer.value = values_of(received_);
    for (std::size_t a = answer.axis_count; a < answer.value.size(); ++a) answer.value[a] = 0.0;
  }

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
