// node/stop.h -- the request to stop, from a signal or from the node itself.
#pragma once

#include <chrono>

namespace cordis::node {

/// SIGINT, SIGTERM and SIGHUP, unless that is ignored, become a request to stop that every thread
/// can ask for and wait on. A motor must not be left alone when a terminal is closed. SIGPIPE is
/// ignored. Call once at the beginning of main, before any thread exists.
void install_stop_signals();

[[nodiscard]] bool stop_requested() noexcept;

/// Asks the process to stop, as a signal would. Safe from any thread and from a signal handler.
void request_stop() noexcept;

/// Sleeps until a stop is requested, at most so long; true when it was.
bool wait_for_stop(std::chrono::nanoseconds at_most) noexcept;

}  // namespace cordis::node
