// sim_node/frame_publisher.cpp
#include "sim_node/frame_publisher.h"

#include <algorithm>
#include <chrono>

#include "node/stop.h"
#include "sim_node/run/frame_message.h"

namespace cordis::sim {
namespace {

constexpr std::chrono::milliseconds kReaderPollPeriod{2};
constexpr std::uint64_t kBatchesAhead = 8;  // of a reader that gets them all, of 32 that DDS keeps
constexpr std::chrono::milliseconds kLongestPause{1000};  // of a scene whose reader takes nothing
// The pause of a scene beside a reader that has stopped. Fast DDS does not name the reader that is behind: one
// that lives has acknowledged within two heartbeats of scene/signals.
constexpr std::chrono::milliseconds kPauseBesideStopped{100};

static_assert(static_cast<int>(engine::Quantity::kDistance) == msg::QUANTITY_DISTANCE);
static_assert(static_cast<int>(engine::Quantity::kElongation) == msg::QUANTITY_ELONGATION);
static_assert(static_cast<int>(engine::Quantity::kSpeed) == msg::QUANTITY_SPEED);
static_assert(static_cast<int>(engine::Quantity::kSpeedX) == msg::QUANTITY_SPEED_X);
static_assert(static_cast<int>(engine::Quantity::kSpeedY) == msg::QUANTITY_SPEED_Y);
static_assert(static_cast<int>(engine::Quantity::kSpeedZ) == msg::QUANTITY_SPEED_Z);
static_assert(static_cast<int>(engine::Quantity::kSlip) == msg::QUANTITY_SLIP);
static_assert(static_cast<int>(engine::Quantity::kForce) == msg::QUANTITY_FORCE);
static_assert(static_cast<int>(engine::Quantity::kImpulse) == msg::QUANTITY_IMPULSE);
static_assert(static_cast<int>(engine::Quantity::kAge) == msg::QUANTITY_AGE);
static_assert(static_cast<int>(engine::Quantity::kRestLength) == msg::QUANTITY_REST_LENGTH);
static_assert(static_cast<int>(engine::Quantity::kMassA) == msg::QUANTITY_MASS_A);
static_assert(static_cast<int>(engine::Quantity::kMassB) == msg::QUANTITY_MASS_B);
static_assert(static_cast<int>(engine::Quantity::kRestAngle) -
                  static_cast<int>(engine::Quantity::kAngle) ==
              msg::QUANTITY_REST_ANGLE - msg::QUANTITY_ANGLE);
static_assert(engine::kNoLink == msg::NO_INDEX);
static_assert(kLinkIsIdle == msg::LINK_IS_IDLE);
static_assert(kMaxBonds == msg::MAX_BONDS);

/// The contract adds quantities at its end, after QUANTITY_NONE.
msg::EventQuantity message_of(engine::Quantity quantity) noexcept {
  if (quantity == engine::Quantity::kSlid) return msg::QUANTITY_SLID;
  if (quantity == engine::Quantity::kNone) return msg::QUANTITY_NONE;
  if (engine::is_of_angle(quantity)) {
    const int place = static_cast<int>(quantity) - static_cast<int>(engine::Quantity::kAngle);
    return static_cast<msg::EventQuantity>(msg::QUANTITY_ANGLE + place);
  }
  return static_cast<msg::EventQuantity>(quantity);
}

}  // namespace

FramePublisher::FramePublisher(dds::Participant& participant, std::uint64_t epoch,
                               InputPublisher& inputs)
    : inputs_(inputs),
      frame_writer_(participant, dds::Topic::kFrame),
      signal_writer_(participant, dds::Topic::kSignals),
      event_writer_(participant, dds::Topic::kEvents) {
  frame_.epoch(epoch);
  events_.epoch(epoch);
  signals_.epoch(epoch);
  thread_ = std::thread([this] { loop(); });
}

FramePublisher::~FramePublisher() {
  ending_.store(true);
  wake_.release();
  thread_.join();
  if (keeps_frames_) frame_writer_.finish();
  signal_writer_.finish();
  event_writer_.finish();
}

bool FramePublisher::wait_for_signal_reader(const std::string& node, bool is_paced,
                                            std::chrono::milliseconds at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  while (!signal_writer_.has_reader_of(node)) {
    if (node::wait_for_stop(kReaderPollPeriod) || std::chrono::steady_clock::now() > end)
      return false;
  }
  is_paced_ = is_paced;
  return true;
}

/// Waits for the readers of a topic. @param has_stopped  one did not take what was written before this
template <class Writer>
void FramePublisher::wait_for_readers(Writer& writer, bool& has_stopped) {
  has_stopped = !writer.wait_until_acknowledged(has_stopped ? kPauseBesideStopped : kLongestPause);
}

void FramePublisher::write_signals() {
  count(signal_writer_.write(signals_));
  if (is_paced_ && signals_.batch() % kBatchesAhead == 0)
    wait_for_readers(signal_writer_, has_stopped_reader_);
}

/// DDS keeps one frame: the next one may replace it where it has not arrived.
void FramePublisher::write_frame() {
  const bool is_due = !has_stopped_watcher_ || frame_.frame() % kBatchesAhead == 0;
  if (keeps_frames_ && is_due) wait_for_readers(frame_writer_, has_stopped_watcher_);
  count(frame_writer_.write(frame_));
}

bool FramePublisher::submit(FrameStore& store, const engine::World& world, double simulated_s,
                            std::int64_t now_nsec, std::int64_t action_nsec) noexcept {
  if (is_busy()) {
    frames_left_out_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  store.turn(world, simulated_s, now_nsec, action_nsec);
  submitted_ = &store;
  busy_.store(true, std::memory_order_release);
  wake_.release();
  return true;
}

void FramePublisher::wake_early() noexcept {
  if (!woken_early_.exchange(true, std::memory_order_acq_rel)) wake_.release();
}

void FramePublisher::loop() {
  for (;;) {
    wake_.acquire();
    woken_early_.store(false, std::memory_order_release);
    count(inputs_.publish());  // before the frame that they lead to
    if (busy_.load(std::memory_order_acquire)) {
      publish_frame(submitted_->shape(), submitted_->published());
      publish_signals(submitted_->shape(), submitted_->published());
      publish_step_signals(submitted_->shape(), submitted_->published());
      publish_events(submitted_->shape(), submitted_->published().events);
      busy_.store(false, std::memory_order_release);
      busy_.notify_one();
    }
    if (ending_.load()) return;
  }
}

void FramePublisher::count(bool written) noexcept {
  if (!written) unwritten_.fetch_add(1, std::memory_order_relaxed);
}

void FramePublisher::publish_frame(const FrameShape& shape, const FrameBuffer& buffer) {
  put_frame(shape, buffer, frame_);
  frame_.frame(frame_.frame() + 1);
  write_frame();
}

void FramePublisher::publish_signals(const FrameShape& shape, const FrameBuffer& buffer) {
  const bool nothing_new = buffer.row_count == 0 && buffer.dropped_rows == 0;
  if (shape.signal_count == 0 || nothing_new) return;
  signals_.version(shape.version);
  signals_.batch(signals_.batch() + 1);
  signals_.signal_count(static_cast<std::uint32_t>(shape.signal_count));
  signals_.stride_steps(shape.stride_steps);
  signals_.first_step(buffer.first_step);
  signals_.dropped_rows(buffer.dropped_rows);
  signals_.rate(msg::RATE_GESTURE);
  signals_.row_step().clear();
  if (!shape.has_even_rows) {
    signals_.row_step().assign(
        buffer.row_steps.begin(),
        buffer.row_steps.begin() + static_cast<std::ptrdiff_t>(buffer.row_count));
  }
  const auto values = static_cast<std::ptrdiff_t>(buffer.row_count * shape.signal_count);
  signals_.value().assign(buffer.rows.begin(), buffer.rows.begin() + values);
  write_signals();
}

void FramePublisher::publish_step_signals(const FrameShape& shape, const FrameBuffer& buffer) {
  constexpr std::size_t kMaxValues = 4096;  // a message then fits into one datagram
  const std::size_t columns = shape.step_signal_count;
  if (columns == 0 || (buffer.step_row_count == 0 && buffer.dropped_step_rows == 0)) return;
  const std::size_t rows_at_once = std::max<std::size_t>(1, kMaxValues / columns);
  signals_.version(shape.version);
  signals_.rate(msg::RATE_STEP);
  signals_.signal_count(static_cast<std::uint32_t>(columns));
  signals_.stride_steps(1);
  signals_.row_step().clear();
  signals_.dropped_rows(buffer.dropped_step_rows);
  std::size_t row = 0;
  do {
    const std::size_t rows = std::min(rows_at_once, buffer.step_row_count - row);
    const double* values = buffer.step_rows.data() + row * columns;
    signals_.batch(signals_.batch() + 1);
    signals_.first_step(buffer.first_step_row + row);
    signals_.value().assign(values, values + rows * columns);
    write_signals();
    signals_.dropped_rows(0);
    row += rows;
  } while (row < buffer.step_row_count);
}

void FramePublisher::publish_events(const FrameShape& shape, const EventRoom& room) {
  if (room.is_empty()) return;
  std::vector<msg::LinkEvent>& message = events_.event();
  message.resize(room.events().size());
  for (std::size_t i = 0; i < message.size(); ++i) {
    const engine::LinkEvent& event = room.events()[i];
    const bool of_a_link = event.link != engine::kNoLink;
    const auto first = static_cast<std::uint32_t>(of_a_link ? shape.first_state_link : 0);
    message[i].step(event.step);
    message[i].link(event.link + first);
    message[i].mat_a(event.mat_a);
    message[i].mat_b(event.mat_b);
    message[i].state_machine(event.state_machine);
    message[i].from_state(event.from);
    message[i].to_state(event.to);
    message[i].quantity(message_of(event.quantity));
    message[i].value(event.value);
    message[i].energy_j(event.energy);
  }
  lost_events_.fetch_add(room.lost(), std::memory_order_relaxed);
  events_.version(shape.version);
  events_.batch(events_.batch() + 1);
  events_.lost(room.lost());
  count(event_writer_.write(events_));
}

}  // namespace cordis::sim
