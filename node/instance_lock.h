// node/instance_lock.h -- names of which one process of this machine is the holder.
#pragma once

#include <string>

namespace cordis::node {

/// Claims a name: an abstract socket, so that it is free again when the process ends, whichever
/// way, and leaves nothing behind. Neither allocates nor throws.
/// @return the socket, which holds the name until it is closed; -1 when another one does
[[nodiscard]] int try_to_lock(const char* name) noexcept;

/// Claims a name until the process ends.
/// @throws std::runtime_error with `refusal` when another process holds it.
void lock_instance(const std::string& name, const std::string& refusal);

}  // namespace cordis::node
