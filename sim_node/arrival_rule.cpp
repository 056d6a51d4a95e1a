// sim_node/arrival_rule.cpp
#include "sim_node/arrival_rule.h"

#include <algorithm>

#include "sim_node/scene/sections/assembly.h"

namespace cordis::sim {

static_assert(ArrivalRule::kMaxDevices == scene::kMaxDevices);
namespace {

constexpr double kGain = 1.0 / 8.0;    // of an observed interval
constexpr double kLargestStep = 0.25;  // by which one changes what is known [periods]
constexpr double kEveryPeriod = 1.5;   // a shorter interval is that of a device of the scene's rate
constexpr double kEarlier = 0.5;       // than its interval says, a sample may be due [periods]
constexpr std::uint64_t kMaxOwed = 2;  // samples

}  // namespace

ArrivalRule::ArrivalRule(double rate_hz, std::int64_t now_nsec) : grid_(rate_hz, now_nsec) {
  known_.reserve(kMaxDevices);
}

void ArrivalRule::restart(double rate_hz, std::int64_t now_nsec) noexcept {
  grid_ = node::PeriodGrid(rate_hz, now_nsec);
  known_.clear();
}

void ArrivalRule::begin_wait(std::span<const Device> devices) noexcept {
  devices = devices.first(std::min(devices.size(), kMaxDevices));
  known_.resize(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Device& device = devices[i];
    const bool is_same = known_[i].id == device.id && known_[i].counted <= device.sent;
    if (!is_same) known_[i] = {.id = device.id, .counted = device.sent};
  }
  mark(devices);
}

void ArrivalRule::mark(std::span<const Device> devices) noexcept {
  for (std::size_t i = 0; i < known_.size(); ++i) known_[i].marked = devices[i].sent;
}

bool ArrivalRule::is_sample_due(const Known& known) noexcept {
  return static_cast<double>(known.silent + 1) >= known.interval - kEarlier;
}

bool ArrivalRule::have_come(std::span<const Device> devices) const noexcept {
  bool any_due = false;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const Known& known = known_[i];
    if (!devices[i].plays || !is_sample_due(known)) continue;
    if (devices[i].sent - known.marked < known.owed) return false;
    any_due = true;
  }
  return any_due;
}

bool ArrivalRule::is_due(std::span<const Device> devices, std::int64_t now_nsec) noexcept {
  const bool has_begun = now_nsec >= grid_.begin_nsec();
  if (!has_begun) mark(devices);
  const bool is_complete = has_begun && have_come(devices);
  if (is_complete && now_nsec < grid_.end_nsec()) grid_.follow(now_nsec);
  return is_complete || now_nsec >= grid_.end_nsec();
}

std::uint64_t ArrivalRule::begin_tick(std::span<const Device> devices,
                                      std::int64_t now_nsec) noexcept {
  const std::uint64_t skipped = grid_.advance(now_nsec);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    Known& known = known_[i];
    const std::uint64_t sent = devices[i].sent - known.counted;
    known.counted = devices[i].sent;
    if (sent == 0) {
      const bool is_missed = devices[i].plays && known.interval < kEveryPeriod;
      known.owed = is_missed ? kMaxOwed : 1;
      known.silent += 1 + skipped;
      continue;
    }
    const double interval =
        static_cast<double>(known.silent + 1 + skipped) / static_cast<double>(sent);
    known.interval += std::clamp(kGain * (interval - known.interval), -kLargestStep, kLargestStep);
    known.silent = 0;
    known.owed = 1;
  }
  return skipped;
}

}  // namespace cordis::sim
