// node/machine/processor_time.h -- what a hypervisor takes from this machine.
#pragma once

#include <cstdint>
#include <optional>

#include "node/machine/system_files.h"

namespace cordis::machine {

/// Processor time of all cores since the start of the machine, in ticks of the kernel.
struct ProcessorTime {
  std::uint64_t total = 0;
  std::uint64_t stolen = 0;  ///< given to other guests by the hypervisor while this one wanted it
};

/// From /proc/stat; nothing when it is missing or not understood.
std::optional<ProcessorTime> read_processor_time(const SystemFiles& files);

/// What this process and its children have computed [ns]. Of children the living ones and those that
/// were waited for count; nothing is known of a child whose processor time cannot be read.
std::int64_t family_processor_nsec();

/// The share that was stolen between two readings, 0..1; nothing when one is missing or no time has
/// passed.
std::optional<double> stolen_share(const std::optional<ProcessorTime>& before,
                                   const std::optional<ProcessorTime>& after);

}  // namespace cordis::machine
