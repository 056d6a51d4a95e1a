// device_node/drivers/driver.h -- what the loop asks of a device, real or simulated.
#pragma once

#include <cstdint>
#include <string>

#include "device_node/axis.h"

namespace cordis::device {

/// What a board does with the last force when no host speaks to it any more.
enum class BoardWatchdog : std::uint8_t {
  kLetsGo,  ///< takes it away by itself; a simulated device has nothing to take away
  kNone,    ///< keeps it for good
  kUnknown  ///< not known: expect that the board keeps its last force
};

struct PointerPort;  // device_node/drivers/pointer_port.h

/// One device as its loop sees it: sensors to read, motors to write.
///
/// What the two carry depends on the role:
///   role mass     read() gives positions [m], write() takes forces [N]
///   role liaison  read() gives forces [N],    write() takes positions [m]
/// Only the guard's output is ever written. No function allocates or throws, and none waits longer
/// than a stated part of a period, whatever the device does or says.
class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;

  /// True if the device, as it is set up, can play the role at all.
  [[nodiscard]] virtual bool can_play(Role role) const noexcept = 0;

  /// Begins a life in a role: motors off, a simulated device back at its beginning.
  virtual void start(Role role) noexcept = 0;

  /// What the sensors say now; false when the device does not answer.
  [[nodiscard]] virtual bool read(AxisValues& sensed) noexcept = 0;

  /// How old the command of the next write() is [s]. Role liaison: positions do not fade like
  /// forces, and a driver whose motors pull to them lets go once they are as old as the watchdog.
  virtual void record_age(double /*age_s*/) noexcept {}

  /// Hands the motors what they hold for one period. A simulated device lives through that period
  /// here, and no other clock moves it. False when the device does not answer.
  [[nodiscard]] virtual bool write(const AxisValues& commanded) noexcept = 0;

  /// True if the motors take another command within a period: then, in real time, each period begins
  /// with begin_period() and read(), and change_command() follows when the answer comes. False: a
  /// period is one write(), followed by read(), as in lockstep.
  virtual bool changes_within_period() const noexcept { return false; }

  /// The period before is over, and the next one begins. A simulated device lives to the end of the
  /// one before. False when the device does not answer.
  [[nodiscard]] virtual bool begin_period() noexcept { return true; }

  /// The motors hold this from now on, beyond the end of the period. A simulated device has lived
  /// until now under the command before. False when the device does not answer.
  /// @param share  of the present period that is over, 0..1
  [[nodiscard]] virtual bool change_command(const AxisValues& /*commanded*/,
                                            double /*share*/) noexcept {
    return true;
  }

  /// True if it drives motors of this world. For a simulated device no time passes while a scene in
  /// lockstep is silent or over; a hand at a real one lives on.
  virtual bool has_motors() const noexcept { return false; }

  /// Where its device is plugged in, for a person; empty without one.
  virtual std::string address() const { return {}; }
  /// True if the device is not there because another process drives it.
  virtual bool is_taken() const noexcept { return false; }

  virtual BoardWatchdog board_watchdog() const noexcept { return BoardWatchdog::kLetsGo; }

  /// True if write() returns false because the motors have been let go of outside this loop: by the
  /// board, in an emergency stop for instance, or by the guardian.
  virtual bool is_let_go() const noexcept { return false; }

  /// True if read() returns false because the driver leaves the device to the next strongest node.
  virtual bool is_yielding() const noexcept { return false; }

  /// Where the hand on a page is handed in; null: the driver follows none.
  virtual PointerPort* pointer_port() noexcept { return nullptr; }

  /// Motors off, at once. start() may follow.
  virtual void stop() noexcept = 0;
};

}  // namespace cordis::device
