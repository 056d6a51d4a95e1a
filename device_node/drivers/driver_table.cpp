// device_node/drivers/driver_table.cpp
#include "device_node/drivers/driver_table.h"

#include "device_node/drivers/firefader.h"
#include "device_node/drivers/haply.h"
#include "device_node/drivers/kfb1.h"
#include "device_node/drivers/mock.h"
#include "device_node/drivers/pointer.h"
#include "device_node/drivers/replay.h"
#include "device_node/drivers/script.h"

namespace cordis::device {

std::span<const DriverEntry> driver_table() noexcept {
  static constexpr DriverEntry kTable[] = {
      {"mock", &make_mock},
      {"script", &make_script},
      {"replay", &make_replay},
      {"kfb1", &make_kfb1},
      {"firefader", &make_firefader},
      {"haply", &make_haply},
      {"pointer", &make_pointer, "mock"},
  };
  return kTable;
}

}  // namespace cordis::device
