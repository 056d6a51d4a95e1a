// cli/bench/machine_figures.h -- the machine that figures come from, and what disturbed them.
#pragma once

#include <optional>
#include <string>

#include "node/machine/processor_time.h"
#include "node/machine/system_files.h"

namespace cordis::cli {

/// The machine between the begin and the end of a measurement.
struct MachineFigures {
  std::string processor;  ///< its model, as processor_name() gives it
  unsigned cores = 0;
  std::optional<double> stolen_share;  ///< share of processor time that a hypervisor took
  std::optional<double> load;          ///< programs that want a core, of the last minute
  std::optional<double> lowest_mhz;    ///< slowest core at begin and end, even asleep
  std::optional<double> highest_mhz;

  /// What disturbed the measurement, a sentence each on one line; empty when nothing does.
  std::string disturbances() const;
};

/// Looks at the machine at its construction and at end().
class MachineMeasurement {
 public:
  explicit MachineMeasurement(machine::SystemFiles files = machine::SystemFiles());

  MachineFigures end() const;

 private:
  machine::SystemFiles files_;
  std::optional<machine::ProcessorTime> at_begin_;
  MachineFigures begun_;
};

}  // namespace cordis::cli
