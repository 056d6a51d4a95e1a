// sim_node/plan/table_pulse.h -- pulses of tables that a step may pass over.
#pragma once

#include <cstdint>
#include <optional>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// A part of a table where its value goes away and comes back.
struct TablePulse {
  std::uint32_t drive = 0;  ///< index in NetworkDescription::drives, of the first that follows it
  double time = 0.0;        ///< moment of its peak [s]
  double width = 0.0;       ///< at half of its height, that of the lower side [s]
};

/// The narrowest pulse after 0 s of the tables that drive MATs. One of less than a tenth of what its
/// table goes through along the axis does not count. A step that is no longer meets it.
/// O(times).
std::optional<TablePulse> narrowest_pulse(const engine::NetworkDescription& network);

}  // namespace cordis::plan
