// device_node/traced_driver.h -- a driver that keeps what its motors were given and when.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device_node/drivers/driver.h"

namespace cordis::device {

/// What to keep of the life of a device.
struct TraceSettings {
  std::string file;      ///< empty: nothing is kept
  double last_s = 10.0;  ///< span that is kept, the last of the device's life
};

/// Any driver, with its last samples kept in memory and written as CSV when the device ends:
///   time_nsec,commanded_0,...,sensed_0,...,age_s
/// Each write() or change_command() to the driver makes a line. The line says when that was
/// (CLOCK_MONOTONIC), what the driver was given, what its sensors then said, and how old the
/// answered sample was. Real time: a copy of two rows per period.
class TracedDriver final : public Driver {
 public:
  TracedDriver(std::unique_ptr<Driver> driver, TraceSettings settings, const AxisLayout& layout);
  ~TracedDriver() override;  ///< writes the file; a file that cannot be written is logged

  bool can_play(Role role) const noexcept override { return driver_->can_play(role); }
  void start(Role role) noexcept override { driver_->start(role); }
  bool read(AxisValues& sensed) noexcept override;
  void record_age(double age_s) noexcept override;
  bool write(const AxisValues& commanded) noexcept override;
  bool changes_within_period() const noexcept override { return driver_->changes_within_period(); }
  bool begin_period() noexcept override { return driver_->begin_period(); }
  bool change_command(const AxisValues& commanded, double share) noexcept override;
  bool has_motors() const noexcept override { return driver_->has_motors(); }
  std::string address() const override { return driver_->address(); }
  BoardWatchdog board_watchdog() const noexcept override { return driver_->board_watchdog(); }
  bool is_let_go() const noexcept override { return driver_->is_let_go(); }
  bool is_taken() const noexcept override { return driver_->is_taken(); }
  bool is_yielding() const noexcept override { return driver_->is_yielding(); }
  PointerPort* pointer_port() noexcept override { return driver_->pointer_port(); }
  void stop() noexcept override;

 private:
  struct Row {
    std::int64_t time_nsec = 0;
    AxisValues commanded{};
    AxisValues sensed{};
    double age_s = 0.0;
  };
  Row& newest() noexcept { return rows_[(count_ - 1) % rows_.size()]; }
  void begin_row(const AxisValues& commanded) noexcept;

  std::unique_ptr<Driver> driver_;
  TraceSettings settings_;
  std::size_t axis_count_;
  std::vector<Row> rows_;  // a ring
  std::size_t count_ = 0;  // rows ever begun
  double age_s_ = 0.0;     // of the command that comes next
};

/// The driver itself when nothing is to be kept.
std::unique_ptr<Driver> traced(std::unique_ptr<Driver> driver, const TraceSettings& settings,
                               const AxisLayout& layout);

}  // namespace cordis::device
