// device_node/scene_watch.cpp
#include "device_node/scene_watch.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "device_node/port_assignment.h"
#include "node/time.h"
#include "node/time_scale.h"

namespace cordis::device {
namespace {

constexpr std::int64_t kLongestWait = 1'000'000'000;  // [ns]
constexpr auto kPollPeriod = std::chrono::milliseconds(5);

constexpr std::uint64_t kPresent = 1;
constexpr std::uint64_t kWanted = 2;
constexpr std::uint64_t kLiaison = 4;
constexpr int kVersionShift = 32;

std::uint64_t packed(const SceneWatch::Part& part) noexcept {
  return (part.is_present ? kPresent : 0) | (part.wanted ? kWanted : 0) |
         (part.role == Role::kLiaison ? kLiaison : 0) |
         (std::uint64_t{part.version} << kVersionShift);
}

SceneWatch::Part unpacked(std::uint64_t word) noexcept {
  return {(word & kPresent) != 0, (word & kWanted) != 0,
          (word & kLiaison) != 0 ? Role::kLiaison : Role::kMass,
          static_cast<std::uint32_t>(word >> kVersionShift)};
}

}  // namespace

SceneWatch::SceneWatch(dds::Participant& participant, const DeviceConfig& device,
                       const Driver& driver)
    : device_(device),
      driver_(driver),
      reader_(participant, dds::Topic::kDescription, &arrival_),
      status_reader_(participant, dds::Topic::kStatus, &arrival_),
      part_(packed({})) {
  thread_ = std::thread([this] { loop(); });
}

SceneWatch::~SceneWatch() {
  ending_ = true;
  arrival_.announce();
  thread_.join();
}

SceneWatch::Part SceneWatch::part() const noexcept {
  return unpacked(part_.load(std::memory_order_acquire));
}

void SceneWatch::wait_for_another(const Part& known, std::chrono::milliseconds at_most) const {
  const auto limit = std::chrono::steady_clock::now() + at_most;
  while (part() == known && std::chrono::steady_clock::now() < limit)
    std::this_thread::sleep_for(kPollPeriod);
}

std::string SceneWatch::refusal() const {
  const std::lock_guard lock(refusal_mutex_);
  return refusal_;
}

void SceneWatch::loop() {
  msg::SceneDescription scene;
  while (!ending_) {
    const std::uint32_t seen = arrival_.count();
    while (!ending_ && reader_.take(scene)) take(scene);
    take_statuses();
    const std::int64_t now = node::monotonic_nsec();
    for (node::RepeatedEvent* event : {&questions_, &changes_, &refusals_}) event->report(now);
    if (!ending_) arrival_.wait_until(seen, now + kLongestWait);
  }
}

void SceneWatch::take_statuses() {
  while (!ending_ && status_reader_.take(status_)) {
    if (status_.kind() != msg::KIND_SIM_NODE) continue;
    status_epoch_ = status_.epoch();
    target_rate_hz_ = status_.target_rate_hz();
    update_time_scale();
  }
}

/// In slow motion a sim_node aims at fewer gesture periods per second than its scene has.
void SceneWatch::update_time_scale() noexcept {
  const bool is_paced = status_epoch_ == epoch_ && target_rate_hz_ > 0.0 && gesture_rate_hz_ > 0.0;
  const double scale = is_paced ? target_rate_hz_ / gesture_rate_hz_ : node::kFullTimeScale;
  time_scale_.store(std::clamp(scale, node::kSlowestTimeScale, node::kFullTimeScale),
                    std::memory_order_relaxed);
}

void SceneWatch::take(const msg::SceneDescription& scene) {
  if (scene.epoch() == 0) return refuse("a scene description without an epoch");
  epoch_ = scene.epoch();
  gesture_rate_hz_ = scene.gesture_rate_hz();
  update_time_scale();
  const PortAssignment wanted = part_of(scene, device_, driver_);
  if (!wanted.impossible.empty()) return refuse(wanted.impossible);
  refuse({});
  if (wanted.questionable != questionable_ && !wanted.questionable.empty() &&
      questions_.record(node::monotonic_nsec()))
    spdlog::warn("{}", wanted.questionable);
  questionable_ = wanted.questionable;

  const Part before = part();
  Part now{true, wanted.wanted, wanted.role, before.version};
  if (now == before) return;
  ++now.version;
  record_part(now, scene);
  part_.store(packed(now), std::memory_order_release);
}

/// Remembers why a description is refused, and reports it when it is another reason. @param why
/// empty: it is not
void SceneWatch::refuse(const std::string& why) {
  const std::lock_guard lock(refusal_mutex_);
  if (refusal_ == why) return;
  refusal_ = why;
  if (!why.empty() && refusals_.record(node::monotonic_nsec())) spdlog::error("{}: refused", why);
}

void SceneWatch::record_part(const Part& part, const msg::SceneDescription& scene) {
  if (!changes_.record(node::monotonic_nsec())) return;
  if (part.wanted) {
    spdlog::info("role {} in scene '{}'", name_of(part.role), scene.name());
  } else {
    spdlog::info("scene '{}' does not play '{}'; waiting for one that does", scene.name(),
                 device_.name);
  }
}

}  // namespace cordis::device
