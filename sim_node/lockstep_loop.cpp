// sim_node/lockstep_loop.cpp
#include "sim_node/lockstep_loop.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/time.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 50ms;  // how long a wait for a sample may keep the loop from a stop
constexpr std::int64_t kLongWait = 2'000'000'000;  // for a sample [ns]

}  // namespace

LockstepLoop::LockstepLoop(SceneLoop& loop, dds::Participant& participant, Patience patience)
    : loop_(loop), patience_(std::move(patience)), roster_(participant) {}

std::string LockstepLoop::run() {
  while (!loop_.finished() && absence_.empty()) {
    if (!loop_.execute_or_wait()) {
      waits_since_nsec_ = 0;
      continue;
    }
    if (loop_.simulation().is_between_ticks() && !receive()) continue;
    if (!loop_.advance()) continue;
    loop_.devices().answer_all(loop_.simulation());
  }
  return absence_;
}

bool LockstepLoop::receive() {
  loop_.devices().receive(loop_.simulation(), loop_.inputs());
  for (const DeviceExchange& device : loop_.simulation().devices()) {
    if (device.has_new_sample()) continue;
    if (!loop_.devices().holds_sample_of(device)) report_wait(device);
    loop_.devices().wait(kPatience);
    return false;
  }
  waits_since_nsec_ = 0;
  return true;
}

/// Says for whom a scene in lockstep has long been waiting, and whether that node is alive. Every
/// wait is one event.
void LockstepLoop::report_wait(const DeviceExchange& device) {
  const std::int64_t now = node::monotonic_nsec();
  absences_.report(now);
  silences_.report(now);
  roster_.update();
  if (waits_since_nsec_ == 0) {
    waits_since_nsec_ = now;
    is_wait_reported_ = false;
  }
  const bool is_known = std::ranges::count(patience_.played, device.device()) > 0;
  if (!is_known && patience_.wait_nsec > 0 && now - waits_since_nsec_ >= patience_.wait_nsec)
    absence_ = sentence_of_absence(device);
  if (is_wait_reported_ || now - waits_since_nsec_ < kLongWait) return;
  is_wait_reported_ = true;
  const std::string alive = roster_.name_of(msg::KIND_DEVICE_NODE);
  if (!(alive.empty() ? absences_ : silences_).record(now)) return;
  std::string port;  // the first of the device
  for (const scene::Port& one : loop_.simulation().scene().ports) {
    if (port.empty() && one.device_id == device.device_id()) port = one.name;
  }
  const std::string who = alive.empty() ? "no device_node of the session is alive"
                                        : "device_node " + alive + " is alive, and sends no sample";
  spdlog::warn(
      "has been waiting for the device '{}' for {} s: {}; nothing moves until it plays port '{}'",
      device.device(), kLongWait / 1'000'000'000, who, port);
}

std::string LockstepLoop::sentence_of_absence(const DeviceExchange& device) const {
  return "no device '" + device.device() + "' has joined for " +
         std::to_string(patience_.wait_nsec / 1'000'000'000) + " s, and no node of " +
         patience_.launch_file + " plays it: nothing moves without it";
}

}  // namespace cordis::sim
