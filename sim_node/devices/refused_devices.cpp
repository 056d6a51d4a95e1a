// sim_node/devices/refused_devices.cpp
#include "sim_node/devices/refused_devices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/time.h"

namespace cordis::sim {
namespace {

constexpr std::size_t kLongestDriver = 64;

bool makes_sense(const msg::DeviceDescription& description) {
  const auto at_least_zero = [](double value) { return std::isfinite(value) && value >= 0.0; };
  return std::isfinite(description.rate_hz()) && description.rate_hz() > 0.0 &&
         std::isfinite(description.moving_mass_kg()) && description.moving_mass_kg() > 0.0 &&
         at_least_zero(description.viscosity_n_s_per_m()) &&
         at_least_zero(description.stiffness_limit_n_per_m()) &&
         at_least_zero(description.damping_limit_n_s_per_m()) &&
         std::all_of(description.travel_m().begin(), description.travel_m().end(), at_least_zero) &&
         std::all_of(description.force_n().begin(), description.force_n().end(), at_least_zero) &&
         description.delay_periods() < 1000 && description.epoch() != 0;
}

config::DeviceLimits limits_of(const msg::DeviceDescription& description) {
  config::DeviceLimits limits;
  limits.rate_hz = description.rate_hz();
  limits.moving_mass_kg = description.moving_mass_kg();
  limits.viscosity_n_s_per_m = description.viscosity_n_s_per_m();
  limits.stiffness_limit_n_per_m = description.stiffness_limit_n_per_m();
  limits.damping_limit_n_s_per_m = description.damping_limit_n_s_per_m();
  limits.coordinate_travel_m = description.travel_m();
  limits.coordinate_force_n = description.force_n();
  limits.delay_periods = static_cast<int>(description.delay_periods());
  return limits;
}

}  // namespace

void RefusedDevices::play(const scene::Scene& scene) {
  std::vector<PortDemand> demands = demands_of(scene);
  const std::lock_guard lock(mutex_);
  demands_ = std::move(demands);
  evaluate();
}

bool RefusedDevices::receive(const msg::DeviceDescription& description) {
  if (!makes_sense(description)) return false;
  const std::lock_guard lock(mutex_);
  const auto is_same = [&description](const Known& device) {
    return device.device_id == description.device_id() && device.epoch == description.epoch();
  };
  if (std::ranges::any_of(known_, is_same)) return false;
  if (known_.size() >= kMaxKnown) known_.pop_front();
  known_.push_back({description.device_id(), description.epoch(),
                    description.driver().substr(0, kLongestDriver), limits_of(description)});
  evaluate();
  return true;
}

/// All known devices again.
void RefusedDevices::evaluate() {
  std::string text;
  std::size_t count = 0;
  for (const Known& device : known_) {
    std::string why;
    for (const PortDemand& demand : demands_) {
      if (demand.device_id != device.device_id) continue;
      const PortVerdict verdict = verdict_on(demand, device.limits, delay_periods_);
      std::vector<std::string> reasons = verdict.lacks;
      if (!verdict.refusal.empty()) reasons.push_back(verdict.refusal);
      for (const std::string& reason : reasons) why += (why.empty() ? "" : "; ") + reason;
    }
    if (why.empty() || count == kMaxRefused) continue;
    refused_[count++].store(device.epoch, std::memory_order_relaxed);
    text += (text.empty() ? "" : "; ") + why + ": driver " + device.driver + " is given no force";
  }
  for (; count < kMaxRefused; ++count) refused_[count].store(0, std::memory_order_relaxed);
  const std::int64_t now = node::monotonic_nsec();
  if (text != text_ && !text.empty() && refusals_.record(now)) spdlog::error("{}", text);
  if (text != text_ && text.empty() && returns_.record(now))
    spdlog::info("every device supports the scene again");
  text_ = std::move(text);
}

void RefusedDevices::report_repeats() {
  const std::int64_t now = node::monotonic_nsec();
  const std::lock_guard lock(mutex_);
  refusals_.report(now);
  returns_.report(now);
}

bool RefusedDevices::refuses(std::uint64_t epoch) const noexcept {
  for (const auto& refused : refused_) {
    const std::uint64_t candidate = refused.load(std::memory_order_relaxed);
    if (candidate == epoch) return true;
    if (candidate == 0) return false;
  }
  return false;
}

std::string RefusedDevices::text() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

}  // namespace cordis::sim
