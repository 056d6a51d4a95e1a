// device_node/drivers/driver_table.h -- the drivers there are: the one place to add another.
#pragma once

#include <memory>
#include <span>

#include "device_node/drivers/driver.h"
#include "node/config/value.h"

namespace cordis::device {

/// A driver as a device file names it: `driver: mock` with its settings in the mapping `mock:`.
struct DriverEntry {
  const char* name;

  /// Builds the driver from its mapping (which may be absent: all defaults). Adds problems, and
  /// returns nothing, when the mapping has errors or there have been errors before.
  std::unique_ptr<Driver> (*make)(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems);

  /// The mapping of another driver that lies beneath the own one: its keys count where the own mapping
  /// does not say otherwise. Null: none does.
  const char* beneath = nullptr;
};

/// All drivers. The first is the default.
std::span<const DriverEntry> driver_table() noexcept;

}  // namespace cordis::device
