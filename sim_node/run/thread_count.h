// sim_node/run/thread_count.h -- how many threads share a step.
#pragma once

#include <cstddef>
#include <string>

#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/world.h"

namespace cordis::sim {

inline constexpr std::size_t kFastest = 0;  ///< as many threads as are fastest
/// Largest value of `threads`.
inline constexpr std::size_t kMaxThreads = engine::ThreadTeam::kMaxMembers;

/// How many threads share a step now, and why, for a person; empty where there was no choice.
struct SharedSteps {
  std::size_t threads = 1;
  std::string text;
};

/// Lets threads share the steps of a world. Of kFastest, 1, 2, 4 and so on up to `most` are measured on a
/// second world of its network: more threads count only where they save a tenth of the time. That takes about 50 ms
/// for each count. A step that cannot be taken apart has one thread. Results do not depend on it.
/// @param threads  so many, or kFastest
/// @throws std::runtime_error when the system does not give so many threads; what World throws
SharedSteps share_steps(engine::World& world, std::size_t threads, std::size_t most);

/// How many threads may share the steps of a realtime session: each other node keeps a core.
/// @param nodes  other nodes of the session @param processors  that this process may use
std::size_t max_threads_beside(std::size_t nodes, std::size_t processors) noexcept;

}  // namespace cordis::sim
