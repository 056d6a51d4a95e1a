// device_node/drivers/motor_release.h -- the last frame of a real device: no force, whatever ends
// this process.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace cordis::device {

/// Bytes that take all force from the motors of a device, wherever in a frame its board is.
struct ReleaseFrame {
  std::array<std::uint8_t, 96> bytes{};
  std::size_t length = 0;  ///< 0: there is none
};

/// Writes the frame to the open descriptor of a device. A serial line that takes no more drops
/// first what waits on it. Waits for nothing; async-signal-safe.
/// @return whether the system took all of it
[[nodiscard]] bool write_release(int file, const ReleaseFrame& frame) noexcept;

/// From now on each signal that ends a process by its default action (SIGSEGV, SIGABRT, SIGQUIT and
/// so on) writes the armed frame first, and then does what it did before. Signals with a handler
/// keep it. One that is ignored, as SIGQUIT is in the background of a shell, stays so. Call on the
/// loop thread: its handlers get a stack of their own.
void install_crash_release() noexcept;

/// The frame and the descriptor that a crash uses. `frame` is copied.
void arm_crash_release(int file, const ReleaseFrame& frame) noexcept;
void disarm_crash_release() noexcept;

}  // namespace cordis::device
