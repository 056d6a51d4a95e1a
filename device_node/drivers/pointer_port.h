// device_node/drivers/pointer_port.h -- between the loop of a device and the hand on a page.
#pragma once

#include <cstdint>

#include "device_node/axis.h"
#include "node/latest.h"

namespace cordis::device {

/// Time without a message after which a page counts as gone [s].
inline constexpr double kPageSilence = 0.5;

/// Where the hand on a page wants the axes.
struct PointerTarget {
  std::uint64_t epoch = 0;   ///< epoch of the viz_node
  std::uint64_t number = 0;  ///< number of its message
  bool holds = false;        ///< the page holds the device
  std::uint32_t held = 0;    ///< bit n: axis n is held
  AxisValues target_m{};     ///< at the first target of a hold: where the device is now
};

/// What that hand feels.
struct PointerFeel {
  std::uint64_t epoch = 0;        ///< epoch of the viz_node followed now or last; 0: none yet
  std::uint64_t felt_number = 0;  ///< newest target whose force is at the motors; 0: none yet
  std::int64_t felt_nsec = 0;     ///< when it came there [CLOCK_MONOTONIC]
  bool holds = false;
  AxisValues position_m{};
  AxisValues target_m{};
  AxisValues force_n{};  ///< on the handle
};

/// Both directions. The loop of the device takes targets and puts what is felt; another thread, which
/// speaks DDS, does the opposite. No lock.
struct PointerPort {
  node::Latest<PointerTarget> target;
  node::Latest<PointerFeel> feel;
};

}  // namespace cordis::device
