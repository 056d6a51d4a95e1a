// sim_node/devices/device_exchange.h -- what sim_node exchanges with one device in a gesture
// period.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "idl/gesture.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/devices/passivity_controller.h"
#include "sim_node/devices/sample_sequence.h"
#include "sim_node/devices/travel_stops.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

using scene::Role;

constexpr std::size_t kMaxAxes = msg::MAX_AXES;

/// The ports of one device: takes its samples, moves or pushes the MATs over the sub-steps, and
/// makes the answers.
///
/// A new position is reached in a ramp over one period. The answer holds the forces of its last
/// sub-step, computed at the position of the sample itself. No virtual damping is lost, and no
/// delay added. When the period ends between two sub-steps, that position is short of the sample by
/// the part of the ramp that is left, and the next sub-step is on the next ramp. A device that is
/// silent for kDisconnectedAfter is disconnected: its MATs hold still, its forces count as 0, and
/// it is given none. When it is received again, or another process is received in its place, that
/// takes over gradually, within kRejoin, and so do the forces it is given: neither side jumps. Both
/// are counted in ticks. Likewise after a gap as long in its samples, when the scene itself
/// stalled; one that is always late plays what comes. Real time: every function but the constructor
/// is O(axes), allocates nothing and does not throw.
///
/// Whoever takes part in the session may write a sample, so no number of it is trusted. Positions
/// and forces stay within the reach of the device. When its SampleSequence restarts, the samples of
/// the device are taken again, whatever came before, and it takes over gradually.
class DeviceExchange {
 public:
  static constexpr double kDisconnectedAfter = 0.02;  ///< [s]
  static constexpr double kRejoin = 0.1;              ///< [s]
  static constexpr double kRestart = 0.25;   ///< above the longest watchdog of a device [s]
  static constexpr double kDescribed = 1.0;  ///< [s]

  /// @param rate_hz  ticks per second
  /// @param epoch    of this sim_node; its messages carry it
  DeviceExchange(std::string device, std::uint32_t device_id, Role role,
                 std::vector<scene::Port> ports, double rate_hz, std::uint64_t epoch);

  /// Role liaison: from now on its ports are damped when they make energy.
  void damp_with(PassivityController controller) { passivity_controller_ = std::move(controller); }

  /// Role liaison: from now on its masses are stopped where the travel of the device ends.
  void stop_with(TravelStops stops) { travel_stops_ = std::move(stops); }

  /// Goes on where the exchange of the same device was in the scene before, so that neither side
  /// takes a message twice or for one of another. The device takes over gradually as after a
  /// loss; with `at_once` it plays on as it did, when its role is the same.
  void take_over(const DeviceExchange& before, bool at_once) noexcept;

  /// Lets go of the device as if it were disconnected: until its next sample that begin_tick() finds.
  void let_go() noexcept;

  /// What became of a message of the device.
  enum class Reception : std::uint8_t {
    kNew,       ///< taken: it will be played in the next tick
    kRepeated,  ///< the message answered last, sent again: the last answer is wanted again
    kRefused    ///< malformed, not finite, or older than what is known
  };
  /// Precondition: role mass. @param is_supported  false: the scene is beyond the limits of the
  /// device; it counts as disconnected, though its samples are answered. @param reach  of the device
  Reception receive(const msg::GesturePositions& sample, bool is_supported = true,
                    const DeviceReach& reach = {}) noexcept;
  /// Precondition: role liaison.
  Reception receive(const msg::GestureForces& sample, bool is_supported = true,
                    const DeviceReach& reach = {}) noexcept;

  /// Counts a sample that is not considered.
  void refuse() noexcept { ++refused_count_; }

  /// The sample taken last is of a process that has described itself.
  void record_described() noexcept { undescribed_ticks_ = 0; }
  /// True if a sample of such a process was taken within kDescribed: none of another process that
  /// has not described itself takes its place.
  bool is_described() const noexcept { return undescribed_ticks_ < described_ticks_; }

  /// Begins a tick: takes over the newest sample.
  void begin_tick() noexcept;

  /// Imposes positions or forces for sub-step `number` of the tick, from 1.
  /// @param share  of the period that is over at the sub-step, in (0, 1]
  void play(engine::World& world, int number, double share) noexcept;

  /// The answer after the last sub-step. Forces: what the links do to the port, as far as the
  /// device has taken over. All forces are 0 when `safe` is false.
  msg::GestureForces& answer_forces(const engine::World& world, bool safe,
                                    std::int64_t now_nsec) noexcept;
  /// Positions: where the MATs at the ports are. The last ones are repeated when `safe` is false.
  msg::GesturePositions& answer_positions(const engine::World& world, bool safe,
                                          std::int64_t now_nsec) noexcept;

  const std::string& device() const noexcept { return device_; }
  std::uint32_t device_id() const noexcept { return device_id_; }
  Role role() const noexcept { return role_; }
  bool has_new_sample() const noexcept { return has_new_; }
  bool is_disconnected() const noexcept { return silent_ticks_ > patience_ticks_; }
  /// True if no sample has come for kDisconnectedAfter, even if the device is not supported. One
  /// whose answers are to be measured counts as disconnected, and is answered on arrival all the
  /// same.
  bool is_silent() const noexcept { return unheard_ticks_ > patience_ticks_; }
  /// True if the device was refused for longer than kRestart, and is supported now. No answer goes
  /// to it for kRestart (or 8 periods), so that its guard starts again, with forces that grow from
  /// 0 and no energy in its account. One that was refused for a moment, because its description
  /// came a little after its first sample, still has the ramp of its start.
  bool is_restarting() const noexcept { return restart_left_ > 0; }
  /// True if a device was there, fell silent, and was not let go of.
  bool is_missed() const noexcept { return is_expected_ && is_disconnected(); }
  bool has_received() const noexcept { return sequence_.epoch() != 0; }
  /// Epoch and number of the newest sample; 0 when there is none.
  std::uint64_t received_epoch() const noexcept { return sequence_.epoch(); }
  std::uint64_t received_sample() const noexcept { return sequence_.number(); }
  /// Samples received as Reception::kNew.
  std::uint64_t new_count() const noexcept { return new_count_; }
  /// When the newest sample was taken, by the clock of its device; 0 when there is none [ns].
  std::int64_t received_time_nsec() const noexcept { return sequence_.time_nsec(); }
  std::uint64_t refused_count() const noexcept { return refused_count_; }
  /// Samples of the device that never came.
  std::uint64_t lost_sample_count() const noexcept { return sequence_.lost_count(); }
  /// Ticks in which a port of role liaison was damped.
  std::uint64_t passivity_ticks() const noexcept {
    return passivity_controller_ ? passivity_controller_->passivity_ticks() : 0;
  }

 private:
  double force_share() const noexcept;
  template <class Sample, class Values>
  Reception receive(const Sample& sample, const Values& values, bool is_supported,
                    const std::array<double, kMaxAxes>& most) noexcept;
  void take_work(const msg::GestureForces& sample, const DeviceReach& reach,
                 std::uint64_t periods) noexcept;
  template <class Answer>
  void fill_header(Answer& answer, std::int64_t now_nsec) noexcept;

  std::string device_;
  std::uint32_t device_id_;
  Role role_;
  std::vector<scene::Port> ports_;
  std::uint64_t epoch_;
  std::optional<PassivityController> passivity_controller_;
  std::optional<TravelStops> travel_stops_;

  int patience_ticks_;       // of silence, until the device counts as disconnected
  SampleSequence sequence_;  // of the samples that were taken
  std::array<double, kMaxAxes> newest_{};
  std::uint64_t echoed_answer_ = 0;  // role liaison: that the newest sample speaks of
  double hand_work_ = 0.0;           // what the hand had given there [J]
  bool has_new_ = false;
  bool restarted_ = false;  // it is the first of another process, or its numbers restart
  bool new_work_ = false;   // what it reports of its work does not follow from what it reported
                            // before
  bool after_gap_ = false;  // it is the first after a gap of kDisconnectedAfter
  bool is_supported_ = true;
  bool is_expected_ = false;  // it was there in a tick, and it has not been let go of since

  std::array<double, kMaxAxes> from_{};  // axis values at the beginning of the tick
  std::array<double, kMaxAxes> to_{};    // and at its end
  int rejoin_ticks_;
  double rate_hz_;
  int silent_ticks_;
  int restart_left_ = 0;   // ticks without an answer
  int refused_ticks_ = 0;  // with a sample, in a row
  int unheard_ticks_;      // as silent_ticks_, of a device that is not supported too
  int described_ticks_;    // in which a described process keeps its place
  int undescribed_ticks_;  // since a sample of one, at most so many
  int rejoin_left_ = 0;
  int even_ticks_ = 0;  // since the last gap, at most rejoin_ticks_

  std::uint32_t axis_count_ = 1;  // of the device, as its samples report
  std::uint64_t answers_ = 0;
  std::uint64_t new_count_ = 0;
  std::uint64_t refused_count_ = 0;
  msg::GestureForces forces_;
  msg::GesturePositions positions_;
};

}  // namespace cordis::sim
