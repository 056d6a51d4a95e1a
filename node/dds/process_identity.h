// node/dds/process_identity.h -- which process a participant belongs to. Included by node/dds,
// the registry of sessions and their tests alone.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cordis::dds {

/// One line that names this process among all of all hosts and times: host since its start, process
/// namespace, process id, and when the process began.
std::string process_identity();

enum class ProcessState : std::uint8_t {
  kAlive,   ///< perhaps stopped
  kEnded,   ///< perhaps not yet waited for by its parent
  kUnknown  ///< another host or process namespace, or not a line of process_identity()
};

ProcessState state_of(std::string_view identity) noexcept;

}  // namespace cordis::dds
