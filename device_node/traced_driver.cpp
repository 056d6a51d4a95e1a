// device_node/traced_driver.cpp
#include "device_node/traced_driver.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "node/config/regular_file.h"
#include "node/time.h"

namespace cordis::device {

TracedDriver::TracedDriver(std::unique_ptr<Driver> driver, TraceSettings settings,
                           const AxisLayout& layout)
    : driver_(std::move(driver)),
      settings_(std::move(settings)),
      axis_count_(static_cast<std::size_t>(layout.count)),
      rows_(static_cast<std::size_t>(std::ceil(settings_.last_s * layout.rate_hz)) + 1) {}

TracedDriver::~TracedDriver() {
  const std::string reason = config::reason_not_to_write(settings_.file);
  if (!reason.empty()) {
    spdlog::error("cannot write the trace '{}': {}", settings_.file, reason);
    return;
  }
  std::ofstream file(settings_.file);
  file << "time_nsec";
  for (const char* what : {"commanded", "sensed"}) {
    for (std::size_t a = 0; a < axis_count_; ++a) file << ',' << what << '_' << a;
  }
  file << ",age_s\n";
  const std::size_t kept = std::min(count_, rows_.size());
  for (std::size_t n = count_ - kept; n < count_; ++n) {
    const Row& row = rows_[n % rows_.size()];
    std::string line = std::to_string(row.time_nsec);
    for (const AxisValues* values : {&row.commanded, &row.sensed}) {
      for (std::size_t a = 0; a < axis_count_; ++a) line += fmt::format(",{:.9g}", (*values)[a]);
    }
    file << line << fmt::format(",{:.9g}\n", row.age_s);
  }
  file.flush();
  if (!file) spdlog::error("cannot write the trace '{}'", settings_.file);
}

void TracedDriver::begin_row(const AxisValues& commanded) noexcept {
  ++count_;
  newest() = {node::monotonic_nsec(), commanded, {}, age_s_};
}

bool TracedDriver::read(AxisValues& sensed) noexcept {
  const bool there = driver_->read(sensed);
  if (count_ > 0) newest().sensed = sensed;
  return there;
}

void TracedDriver::record_age(double age_s) noexcept {
  age_s_ = age_s;
  driver_->record_age(age_s);
}

bool TracedDriver::write(const AxisValues& commanded) noexcept {
  begin_row(commanded);
  return driver_->write(commanded);
}

bool TracedDriver::change_command(const AxisValues& commanded, double share) noexcept {
  begin_row(commanded);
  return driver_->change_command(commanded, share);
}

/// Motors off counts as a command of nothing.
void TracedDriver::stop() noexcept {
  driver_->stop();
  age_s_ = 0.0;
  begin_row({});
}

std::unique_ptr<Driver> traced(std::unique_ptr<Driver> driver, const TraceSettings& settings,
                               const AxisLayout& layout) {
  if (settings.file.empty()) return driver;
  return std::make_unique<TracedDriver>(std::move(driver), settings, layout);
}

}  // namespace cordis::device
