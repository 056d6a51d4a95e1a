// device_node/dds_channel.cpp
#include "device_node/dds_channel.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "device_node/answer_poll.h"
#include "device_node/gesture_wire.h"
#include "node/dds/arrival.h"
#include "node/dds/reader.h"
#include "node/dds/topics.h"
#include "node/dds/writer.h"
#include "node/repeated_event.h"
#include "node/time.h"

namespace cordis::device {
namespace {

using std::chrono::nanoseconds;

template <class Sent, class Received>
class DdsChannel final : public GestureChannel {
 public:
  DdsChannel(dds::Participant& participant, dds::Topic sent, dds::Topic received,
             std::uint32_t device_id, int strength, std::int64_t poll_nsec)
      : writer_(participant, sent, strength),
        reader_(participant, received, &arrival_),
        device_id_(device_id),
        poll_nsec_(poll_nsec) {}

  bool send(const GestureMessage& sample) noexcept override {
    wire::put(sample, device_id_, sent_);
    if (is_awaiting_) record_wait(AnswerPoll::Wait::kInVain);
    is_awaiting_ = poll_nsec_ > 0;
    poll_until_ = node::monotonic_nsec() + poll_nsec_;
    return writer_.write(sent_);
  }

  bool receive(GestureMessage& answer, nanoseconds at_most) noexcept override {
    const std::int64_t deadline = node::monotonic_nsec() + at_most.count();
    for (bool has_updated = false;; has_updated = true) {
      const std::uint32_t seen = arrival_.count();
      while (reader_.take(received_)) {
        if (received_.device_id() != device_id_) continue;  // another device of the session
        wire::take(received_, answer);
        if (is_awaiting_) {
          const bool is_in_time = node::monotonic_nsec() < poll_until_;
          record_wait(is_in_time ? AnswerPoll::Wait::kInTime : AnswerPoll::Wait::kLate);
        }
        return true;
      }
      if (!has_updated) {
        arrival_.update();
        continue;
      }
      const std::int64_t now = node::monotonic_nsec();
      if (at_most.count() <= 0 || now >= deadline) return false;
      if (is_awaiting_ && poll_.is_on() && now < poll_until_) {
        arrival_.poll_until(seen, std::min(poll_until_, deadline));
      } else {
        arrival_.wait_until(seen, deadline);
      }
    }
  }

  double polled_s() const noexcept override {
    return static_cast<double>(arrival_.polled_nsec()) * 1e-9;
  }

 private:
  /// The wait for the answer to the sample sent last is over.
  void record_wait(AnswerPoll::Wait wait) noexcept {
    is_awaiting_ = false;
    if (!poll_.record(wait)) return;
    const bool pays = poll_.verdict() == AnswerPoll::Verdict::kPays;
    node::RepeatedEvent& event = pays ? polls_ : sleeps_;
    if (!event.record(node::monotonic_nsec())) return;
    if (pays) {
      spdlog::info("polls for its answers, for {} us of a period at most", poll_nsec_ / 1000);
    } else {
      spdlog::info("sleeps until its answers come: polling does not find them in time");
    }
  }

  dds::Arrival arrival_;
  dds::Writer<Sent> writer_;
  dds::Reader<Received> reader_;
  std::uint32_t device_id_;
  std::int64_t poll_nsec_;
  std::int64_t poll_until_ = 0;
  bool is_awaiting_ = false;  // the answer to the sample sent last
  AnswerPoll poll_;
  node::RepeatedEvent polls_{"polls for its answers again", spdlog::level::info};
  node::RepeatedEvent sleeps_{"sleeps again until its answers come", spdlog::level::info};
  Sent sent_;
  Received received_;
};

}  // namespace

std::unique_ptr<GestureChannel> make_dds_channel(dds::Participant& participant, Role role,
                                                 std::uint32_t device_id, int strength,
                                                 std::int64_t poll_nsec) {
  if (role == Role::kMass) {
    return std::make_unique<DdsChannel<msg::GesturePositions, msg::GestureForces>>(
        participant, dds::Topic::kPositions, dds::Topic::kForces, device_id, strength, poll_nsec);
  }
  return std::make_unique<DdsChannel<msg::GestureForces, msg::GesturePositions>>(
      participant, dds::Topic::kForces, dds::Topic::kPositions, device_id, strength, poll_nsec);
}

}  // namespace cordis::device
