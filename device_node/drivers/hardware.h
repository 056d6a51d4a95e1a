// device_node/drivers/hardware.h -- what all drivers of things that can be unplugged share.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>

#include "device_node/drivers/driver.h"
#include "device_node/drivers/wire.h"
#include "device_node/force_guard.h"

namespace cordis::device {

/// How the driver stands with its device.
enum class Contact : std::uint8_t {
  kLost,      ///< the wire is closed; it is tried again every retry_s
  kGreeting,  ///< the wire is open, and the first sample of the right device has not come yet: it
              ///< has 3 s, for a board may reset when its line is opened
  kPresent    ///< samples come
};

/// Settings of every such driver.
struct HardwareSettings {
  double answer_within_s = 0.0004;  ///< how long write() waits for the sample it asks for
  double lost_after_s = 0.02;       ///< without a sample, once it is present
  double retry_s = 0.5;
  double coupling_n_per_m = 300.0;  ///< role liaison: between hand and commanded place
  double coupling_n_s_per_m = 1.0;  ///< likewise
  ForceGuardSettings guard;         ///< role liaison: of the forces that follow from it
};

/// A device at the end of a wire that is given forces and answers with positions, request by
/// request. The loop never waits for it longer than answer_within_s, and reads no more than a few
/// kB a period, however much comes. A device that falls silent is lost: the wire is closed, opened
/// again every retry_s, and the driver goes on by itself. What comes late, but before the next
/// request, is taken as it comes. Before a wire is closed, the motors are given no force. A board that
/// fell silent under a force may not have taken that in. So it is given no force again with each
/// greeting, and when this node ends, until it answers.
///
/// A board that says that it has let go of its motors is given no force until it has not said so
/// for 0.1 s. So is one whose forces the guardian has taken away. Meanwhile write() returns false.
///
/// In role mass the device plays as it is. Role liaison is for devices without a sensor of force.
/// There the motors pull the handle to the commanded place by a coupling, F = K (x - x_h) + Z (v -
/// v_h). A guard has the same limits, ramp and watchdog as in role mass. The force of the hand is
/// taken to be -F.
class Hardware : public Driver {
 public:
  Hardware(std::unique_ptr<Wire> wire, const HardwareSettings& settings, const AxisLayout& layout);
  ~Hardware() override;

  bool can_play(Role) const noexcept override { return true; }
  void start(Role role) noexcept override;
  bool read(AxisValues& sensed) noexcept override;
  void record_age(double age_s) noexcept override { age_s_ = age_s; }
  bool write(const AxisValues& commanded) noexcept override;
  bool has_motors() const noexcept override { return true; }
  std::string address() const override { return wire_->address(); }
  bool is_taken() const noexcept override { return wire_->is_taken(); }
  bool is_let_go() const noexcept override { return is_let_go_; }
  void stop() noexcept override;

  Contact contact() const noexcept { return contact_; }
  std::uint64_t late_count() const noexcept { return late_; }  ///< samples not there in time
  std::uint64_t bad_count() const noexcept { return bad_; }    ///< damaged frames

 protected:
  static constexpr std::size_t kLargestMessage = 96;
  using Message = std::array<std::uint8_t, kLargestMessage>;

  /// What a byte brought about.
  enum class Received : std::uint8_t {
    kNothing,
    kGreeted,    ///< the device is the right one
    kWrong,      ///< it is not: the wire is closed
    kSample,     ///< a sample that answers the newest request, as far as can be known
    kOldSample,  ///< one that answers an earlier request
    kLetGo,      ///< the board has let go of its motors, and may go on to
    kLetGoOnce,  ///< it has, and takes forces again
    kRestarted,  ///< the board has restarted and lost its configuration
    kBad         ///< damaged
  };

  /// Discards a partial message and the sent configuration: at an open wire, and again every 0.25 s
  /// until the device is present.
  virtual void begin() noexcept = 0;
  /// Writes what the device is asked first; 0: it need not say what it is.
  virtual std::size_t greet(Message& message) noexcept = 0;
  /// Writes what a device that has greeted receives once; 0: nothing.
  virtual std::size_t configure(Message&) noexcept { return 0; }
  /// Writes what takes the force from the motors wherever in a message the device is. Always the
  /// same bytes.
  virtual std::size_t release(Message& message) const noexcept = 0;
  /// Writes the request that carries forces [N].
  virtual std::size_t request(const AxisValues& force_n, Message& message) noexcept = 0;
  virtual Received receive(std::uint8_t byte) noexcept = 0;
  /// In every period: reports what has repeated itself. @param now_nsec  CLOCK_MONOTONIC
  virtual void report_repeats(std::int64_t /*now_nsec*/) noexcept {}
  /// It has listened, and nothing has come at all.
  virtual void fall_silent() noexcept {}
  virtual void position(AxisValues& position_m) const noexcept = 0;  ///< reads the newest sample

  const AxisLayout& layout() const noexcept { return layout_; }

 private:
  void try_to_open(std::int64_t now) noexcept;
  void greet_now(std::int64_t now) noexcept;
  void hold_motors(std::int64_t until_nsec) noexcept;
  bool was_released() noexcept;
  bool is_silent(std::int64_t now) const noexcept;
  void restart() noexcept;
  void welcome() noexcept;
  void ask(const AxisValues& force_n) noexcept;
  bool listen(std::int64_t until) noexcept;
  bool take(std::span<const std::uint8_t> bytes) noexcept;
  void release_motors() noexcept;
  void lose() noexcept;
  AxisValues coupling_forces(const AxisValues& wanted_m) noexcept;

  std::unique_ptr<Wire> wire_;
  HardwareSettings settings_;
  AxisLayout layout_;
  Role role_ = Role::kMass;
  ForceGuard guard_;
  Contact contact_ = Contact::kLost;
  bool greets_ = true;  // it has yet to say what it is
  bool is_let_go_ = false;
  std::int64_t let_go_until_nsec_ = 0;
  bool asks_force_ = false;          // the newest request
  bool may_hold_force_ = false;      // no answer to a request without a force since one with it
  std::uint32_t releases_seen_ = 0;  // of the guardian
  std::int64_t next_try_nsec_ = 0;
  std::int64_t next_greeting_nsec_ = 0;
  std::int64_t last_sample_nsec_ = 0;
  AxisValues position_{};    // [m]
  AxisValues coupling_n_{};  // role liaison: on the handle [N]
  double age_s_ = 0.0;       // of what is commanded
  AxisValues wanted_before_{};
  AxisValues position_before_{};
  bool moving_ = false;  // the two above are of the period before
  std::uint64_t late_ = 0;
  std::uint64_t bad_ = 0;
};

/// Reads what is common from the mapping of a driver: answer_within_s, lost_after_s, retry_s and
/// `coupling`. A device counts as lost after 0.2 s or 6 periods at the latest, as for a watchdog.
HardwareSettings read_hardware(config::MappingReader& reader, const AxisLayout& layout,
                               config::Problems& problems);

}  // namespace cordis::device
