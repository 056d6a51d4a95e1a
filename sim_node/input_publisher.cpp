// sim_node/input_publisher.cpp
#include "sim_node/input_publisher.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "sim_node/engine/core/hash_version.h"
#include "sim_node/run/input_kind.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

static_assert(static_cast<int>(config::Clock::kRealtime) == msg::PACE_REALTIME);
static_assert(static_cast<int>(config::Clock::kLockstep) == msg::PACE_LOCKSTEP);
static_assert(static_cast<int>(config::Clock::kAsap) == msg::PACE_ASAP);
static_assert(static_cast<int>(PassedBound::kNone) == msg::BOUND_NONE);
static_assert(static_cast<int>(PassedBound::kPartners) == msg::BOUND_PARTNERS);
static_assert(static_cast<int>(PassedBound::kNumber) == msg::BOUND_NUMBER);
static_assert(static_cast<int>(PassedBound::kEnergy) == msg::BOUND_ENERGY);

constexpr std::size_t kInputsPerBatch = 1024;
constexpr auto kBatchEvery = 30ms;  // so that a session that outruns time sends no flood of them

msg::InputScene scene_of(const SceneSource& source, std::uint64_t number, std::uint64_t turn) {
  msg::InputScene scene;
  scene.number(number);
  scene.turn(turn);
  scene.scene_file(source.scene_file);
  for (const config::SourceFile& file : source.files) {
    msg::SourceFile message;
    message.path(file.path);
    message.text(file.text);
    scene.files().push_back(std::move(message));
  }
  scene.integrator(source.integrator);
  scene.step_rate_hz(source.step_rate_hz);
  return scene;
}

}  // namespace

InputPublisher::InputPublisher(dds::Participant& participant, std::uint64_t epoch,
                               config::Clock clock, bool keeps_devices, SceneSource start,
                               InputLog& log)
    : log_(log), writer_(participant, dds::Topic::kInputs) {
  batch_.epoch(epoch);
  batch_.clock(static_cast<msg::InputClock>(clock));
  batch_.keeps_devices(keeps_devices);
  batch_.engine_version(CORDIS_VERSION);
  batch_.hash_version(engine::kHashVersion);
  batch_.scene().push_back(scene_of(start, 1, 0));
}

InputPublisher::~InputPublisher() {
  collect();
  static_cast<void>(write());
  writer_.finish();
}

bool InputPublisher::publish() {
  const bool written = collect();
  const auto now = std::chrono::steady_clock::now();
  if (batch_.turns() == written_turns_ || now - written_at_ < kBatchEvery) return written;
  written_at_ = now;
  return write() && written;
}

/// Puts what has come into the batch, and writes it whenever it is full.
bool InputPublisher::collect() {
  const std::uint64_t turns = log_.turns();  // before the inputs, which then are all there
  bool written = true;
  for (InputRecord record; log_.take(record);) {
    add(record);
    if (++count_ < kInputsPerBatch) continue;
    batch_.turns(std::max(record.turn, batch_.turns()));  // all inputs of earlier turns are there
    written = write() && written;
  }
  batch_.turns(std::max(turns, batch_.turns()));
  return written;
}

bool InputPublisher::write() {
  batch_.batch(batch_.batch() + 1);
  batch_.lost(log_.lost());
  const bool written = writer_.write(batch_);
  batch_.scene().clear();
  batch_.reach().clear();
  batch_.sample().clear();
  batch_.event().clear();
  written_turns_ = batch_.turns();
  count_ = 0;
  return written;
}

void InputPublisher::add(InputRecord& record) {
  switch (record.kind) {
    case InputRecord::Kind::kPositions:
    case InputRecord::Kind::kForces:
      return add_sample(record);
    case InputRecord::Kind::kReach: {
      msg::InputReach reach;
      reach.number(record.number);
      reach.turn(record.turn);
      reach.device_id(record.device_id);
      reach.bound(static_cast<msg::ReachBound>(record.bound));
      reach.value().assign(record.value.begin(), record.value.end());
      batch_.reach().push_back(std::move(reach));
      return;
    }
    case InputRecord::Kind::kCommand:
      if (record.command->verb == msg::VERB_LOAD)
        batch_.scene().push_back(scene_of(record.command->scene, record.number, record.turn));
      else
        add_event(record, input_kind_of(record.command->verb));
      record.command.reset();
      return;
    case InputRecord::Kind::kHold:
      return add_event(record, msg::INPUT_HOLD);
    case InputRecord::Kind::kRepeat:
      return add_event(record, msg::INPUT_REPEAT);
    case InputRecord::Kind::kLetGo:
      return add_event(record, msg::INPUT_LET_GO);
  }
}

void InputPublisher::add_sample(const InputRecord& record) {
  msg::InputSample sample;
  sample.number(record.number);
  sample.turn(record.turn);
  sample.device_id(record.device_id);
  sample.gives_positions(record.kind == InputRecord::Kind::kPositions);
  sample.is_supported(record.is_supported);
  sample.epoch(record.epoch);
  sample.sample(record.sample);
  sample.answered_epoch(record.answered_epoch);
  sample.answered_sample(record.answered_sample);
  sample.time_nsec(record.time_nsec);
  sample.axis_count(record.axis_count);
  sample.work_j(record.work_j);
  const std::size_t count = std::min<std::size_t>(record.axis_count, record.value.size());
  sample.value().assign(record.value.begin(),
                        record.value.begin() + static_cast<std::ptrdiff_t>(count));
  batch_.sample().push_back(std::move(sample));
}

void InputPublisher::add_event(const InputRecord& record, msg::InputKind kind) {
  msg::InputEvent event;
  event.number(record.number);
  event.turn(record.turn);
  event.step(record.step);
  event.kind(kind);
  event.device_id(record.device_id);
  if (kind == msg::INPUT_LET_GO) event.bound(static_cast<msg::SceneBound>(record.bound));
  if (record.command) event.argument(record.command->argument);
  batch_.event().push_back(std::move(event));
}

}  // namespace cordis::sim
