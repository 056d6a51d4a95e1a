// sim_node/devices/refused_devices.cpp
#include "sim_node/devices/refused_devices.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "node/config/number.h"
#include "node/time.h"

namespace cordis::sim {
namespace {

constexpr std::size_t kLongestDriver = 64;
constexpr double kLongestFelt = 0.2;  // no watchdog leaves an older force on a motor [s]

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

void RefusedDevices::play(const scene::Scene& scene, std::int64_t now_nsec) {
  std::vector<PortDemand> demands = demands_of(scene);
  const std::lock_guard lock(mutex_);
  demands_ = std::move(demands);
  for (Known& device : known_) device.verdict.reset();
  evaluate(now_nsec);
}

std::string RefusedDevices::objection_to(const scene::Scene& scene) const {
  const std::vector<PortDemand> demands = demands_of(scene);
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const Known& device : known_) {
    if (!device.is_there || !device.verdict->refusal.empty()) continue;
    const Verdict verdict = check(device, demands);
    if (verdict.refusal.empty() || verdict.waits) continue;
    text += (text.empty() ? "" : "; ") + verdict.refusal;
  }
  return text;
}

bool RefusedDevices::receive(const msg::DeviceDescription& description, std::int64_t now_nsec,
                             bool is_elsewhere) {
  if (!makes_sense(description)) return false;
  const std::lock_guard lock(mutex_);
  const auto is_same = [&description](const Known& device) {
    return device.device_id == description.device_id() && device.epoch == description.epoch();
  };
  if (std::ranges::any_of(known_, is_same)) return false;
  Known device{description.device_id(),
               description.epoch(),
               description.driver().substr(0, kLongestDriver),
               limits_of(description),
               DelayInUse(delay_periods_),
               std::nullopt,
               std::nullopt,
               true,
               is_elsewhere,
               false};
  Row& row =
      known_.size() < kMaxKnown
          ? rows_[known_.size()]
          : *std::ranges::min_element(rows_, {}, [](const Row& old) {
              return std::max(old.newest_nsec.load(std::memory_order_relaxed), old.kept_nsec);
            });
  row.is_refused.store(true);
  row.newest_nsec.store(now_nsec);
  row.kept_nsec = now_nsec;
  row.epoch.store(description.epoch());
  if (known_.size() < kMaxKnown) {
    known_.push_back(std::move(device));
  } else {
    known_[static_cast<std::size_t>(&row - rows_.data())] = std::move(device);
  }
  if (delays_ != nullptr) delays_->add(description.epoch(), description.rate_hz(), now_nsec);
  evaluate(now_nsec);
  return true;
}

void RefusedDevices::keep(std::uint64_t epoch, std::int64_t now_nsec) noexcept {
  for (Row& row : rows_) {
    if (row.epoch.load() == epoch) row.kept_nsec = now_nsec;
  }
}

void RefusedDevices::measure(std::int64_t now_nsec, bool is_measuring) {
  const std::lock_guard lock(mutex_);
  const std::int64_t checked_nsec = std::exchange(checked_nsec_, now_nsec);
  if (!is_measuring && checked_nsec != 0) unmeasured_nsec_ += now_nsec - checked_nsec;
  const std::int64_t measured_nsec = now_nsec - unmeasured_nsec_;
  bool any_changed = false;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    Known& device = known_[i];
    const bool is_there = now_nsec - newest_nsec(i) < AnswerDelays::kSilentNsec;
    any_changed = std::exchange(device.is_there, is_there) != is_there || any_changed;
    if (delays_ == nullptr) continue;
    if (is_there) delays_->add(device.epoch, device.limits.rate_hz, now_nsec);
    device.measured_s = delays_->delay_s(device.epoch, measured_nsec);
    device.was_measured = device.was_measured || device.measured_s.has_value();
    const std::optional<double> measured =
        device.measured_s ? std::optional(*device.measured_s * device.limits.rate_hz)
                          : std::nullopt;
    const DelayInUse before = device.delay;
    if (!device.delay.update(measured, measured_nsec)) continue;
    any_changed = true;
    report_delay(device, before, now_nsec);
  }
  if (any_changed) evaluate(now_nsec);
  const std::lock_guard text_lock(text_mutex_);
  for (DeviceLoop& loop : loops_) {
    const auto device = std::ranges::find(known_, loop.epoch, &Known::epoch);
    if (device != known_.end()) loop.answer_delay_s = counted_delay_s(*device);
  }
}

/// One line when the delay of a device is known, and a warning when it has grown.
void RefusedDevices::report_delay(const Known& device, const DelayInUse& before,
                                  std::int64_t now_nsec) {
  if (!device.measured_s || !device.is_there) return;
  const double periods = device.delay.periods();
  // A little more is no event for a person.
  const bool grown = periods > DelayInUse::kAtAssumed ||
                     (before.is_measured() && periods > 1.5 * before.periods());
  if (!(grown ? delays_grown_ : delays_known_).record(now_nsec, *counted_delay_s(device))) return;
  spdlog::log(grown ? spdlog::level::warn : spdlog::level::info,
              "{:.3g} % of the answers to the device '{}' take at most {:.0f} us: its limits are "
              "those of a delay of {}",
              100.0 * delays_->quantile(), name_of(device), 1e6 * *counted_delay_s(device),
              periods_text(periods));
}

std::optional<double> RefusedDevices::counted_delay_s(const Known& device) {
  if (!device.measured_s) return std::nullopt;
  return device.delay.periods() / device.limits.rate_hz;
}

std::string RefusedDevices::name_of(const Known& device) const {
  for (const PortDemand& demand : demands_) {
    if (demand.device_id == device.device_id) return demand.device;
  }
  return "driver " + device.driver;
}

/// A sentence per port that the device does not support, and what it supports at all of them.
RefusedDevices::Verdict RefusedDevices::check(const Known& device,
                                              const std::vector<PortDemand>& demands) const {
  const double periods = device.delay.periods();
  Verdict result{periods, device.delay.is_measured(), {}, false, {}};
  bool is_refused = false;
  for (const PortDemand& demand : demands) {
    if (demand.device_id != device.device_id) continue;
    const PortVerdict verdict = verdict_on(demand, device.limits, periods);
    std::vector<std::string> reasons = verdict.lacks;
    if (!verdict.refusal.empty()) {
      const std::optional<double> needed =
          delays_ == nullptr ? std::nullopt
                             : largest_supported_delay(demand, device.limits, periods);
      reasons.push_back(verdict.refusal);
      if (needed) {
        reasons.back() +=
            ". " + needed_answer_text(*needed, device.limits.rate_hz, device.measured_s);
      }
    }
    is_refused = is_refused || !reasons.empty();
    if (reasons.empty()) {
      if (const auto why = wait_reason(device, demand)) {
        result.waits = true;
        reasons.push_back(*why);
      }
    }
    for (const std::string& reason : reasons)
      result.refusal += (result.refusal.empty() ? "" : "; ") + reason;
    if (demand.role != scene::Role::kMass) continue;
    const auto supported = supported_stiffness(demand, device.limits, periods);
    if (supported)
      result.supported_stiffness =
          std::min(*supported, result.supported_stiffness.value_or(*supported));
  }
  result.waits = result.waits && !is_refused;
  return result;
}

/// Why a device of another host gets no force at the port before its delay is measured; empty when
/// no delay is too long for the port.
std::optional<std::string> RefusedDevices::wait_reason(const Known& device,
                                                       const PortDemand& demand) const {
  if (delays_ == nullptr || !device.is_elsewhere || device.was_measured) return {};
  const double rate_hz = device.limits.rate_hz;
  const double longest = kLongestFelt * rate_hz;
  const auto needed = largest_supported_delay(demand, device.limits, longest);
  if (!needed || *needed == longest) return {};
  return fmt::format(
      "port '{}' needs an answer within {:.0f} us, and the device '{}' runs on another host: no "
      "force until {} answers are measured",
      demand.port, std::floor(1e6 * *needed / rate_hz), demand.device, enough_answers(rate_hz));
}

/// What the devices of the scene measure and support. Of several processes of a device the one that
/// has sent last.
std::vector<DeviceLoop> RefusedDevices::find_loops(std::string& delay_text) const {
  std::vector<DeviceLoop> loops;
  std::vector<std::pair<std::int64_t, std::size_t>> order;  // read once: the loop goes on writing
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (known_[i].is_there) order.emplace_back(newest_nsec(i), i);
  }
  std::ranges::sort(order, std::ranges::greater());
  for (const auto& [newest, i] : order) {
    const Known& device = known_[i];
    const auto demand = std::ranges::find(demands_, device.device_id, &PortDemand::device_id);
    if (demand == demands_.end()) continue;
    const DeviceLoop loop{demand->device, device.epoch, counted_delay_s(device),
                          device.verdict->supported_stiffness};
    const auto is_same = [&loop](const DeviceLoop& other) { return other.device == loop.device; };
    if (std::ranges::any_of(loops, is_same)) continue;
    if (device.measured_s && *device.measured_s * device.limits.rate_hz > DelayInUse::kAtAssumed) {
      delay_text += (delay_text.empty() ? "" : "; ") +
                    ("the answers to the device '" + loop.device) + "' take " +
                    periods_text(device.delay.periods());
      if (loop.supported_stiffness)
        delay_text += ", and it supports " +
                      config::number_text(std::floor(*loop.supported_stiffness)) + " N/m";
    }
    loops.push_back(loop);
  }
  return loops;
}

/// All known devices whose delay or scene has changed. The loop goes on with the verdicts before
/// until each is replaced by the next.
void RefusedDevices::evaluate(std::int64_t now_nsec) {
  for (Known& device : known_) {
    if (!device.verdict || device.verdict->periods != device.delay.periods() ||
        device.verdict->is_measured != device.delay.is_measured())
      device.verdict = check(device, demands_);
  }
  std::string text;
  bool all_wait = true;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const Known& device = known_[i];
    const std::string& why = device.verdict->refusal;
    rows_[i].is_refused.store(!why.empty());
    if (why.empty() || !device.is_there) continue;
    all_wait = all_wait && device.verdict->waits;
    text += (text.empty() ? "" : "; ") + why;
    if (!device.verdict->waits) text += ": driver " + device.driver + " is given no force";
  }
  std::string delay_text;
  std::vector<DeviceLoop> loops = find_loops(delay_text);
  node::RepeatedEvent& event = all_wait ? waits_ : refusals_;
  if (text != text_ && !text.empty() && event.record(now_nsec))
    spdlog::log(all_wait ? spdlog::level::info : spdlog::level::err, "{}", text);
  if (text != text_ && text.empty() && returns_.record(now_nsec))
    spdlog::info("every device supports the scene now");
  const std::lock_guard lock(text_mutex_);
  text_ = std::move(text);
  delay_text_ = std::move(delay_text);
  loops_ = std::move(loops);
}

void RefusedDevices::report_repeats() {
  const std::int64_t now = node::monotonic_nsec();
  const std::lock_guard lock(mutex_);
  delays_grown_.report(now);
  delays_known_.report(now);
  refusals_.report(now);
  waits_.report(now);
  returns_.report(now);
}

bool RefusedDevices::refuses(std::uint64_t epoch, std::int64_t now_nsec) noexcept {
  bool is_known = false;
  bool is_refused = false;
  for (Row& row : rows_) {
    if (row.epoch.load() != epoch) continue;
    is_known = true;
    row.newest_nsec.store(now_nsec, std::memory_order_relaxed);
    is_refused = is_refused || row.is_refused.load();
  }
  return !is_known || is_refused;
}

std::string RefusedDevices::text() const {
  const std::lock_guard lock(text_mutex_);
  return text_.empty() ? delay_text_ : text_;
}

std::string RefusedDevices::loops_text() const {
  const std::lock_guard lock(text_mutex_);
  std::string text;
  for (const DeviceLoop& loop : loops_) {
    if (!loop.answer_delay_s) continue;
    text += fmt::format("{}the device '{}' is answered within {:.0f} us", text.empty() ? "" : "; ",
                        loop.device, 1e6 * *loop.answer_delay_s);
    if (loop.supported_stiffness)
      text += fmt::format(" and supports {:.4g} N/m", *loop.supported_stiffness);
  }
  return text;
}

std::vector<DeviceLoop> RefusedDevices::loops() const {
  const std::lock_guard lock(text_mutex_);
  return loops_;
}

}  // namespace cordis::sim
