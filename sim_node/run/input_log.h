// sim_node/run/input_log.h -- all that decides what the steps compute, on its way out of the loop.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "idl/gesture.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/run/request.h"
#include "sim_node/run/request_source.h"
#include "sim_node/run/simulation.h"

namespace cordis::sim {

/// One input, in the order in which it took effect.
struct InputRecord {
  enum class Kind : std::uint8_t {
    kPositions,  ///< a sample of a device of role mass
    kForces,     ///< a sample of a device of role liaison
    kReach,      ///< bounds of a device from now on
    kCommand,    ///< a command that was executed
    kHold,       ///< realtime: a turn without play, in which devices are answered
    kRepeat,     ///< a device was sent its last answer again
    kLetGo       ///< devices were let go of
  };
  Kind kind = Kind::kHold;
  std::uint64_t number = 0;  ///< +1 per input, from 2; 1 is the scene that the session began with
  std::uint64_t turn = 0;    ///< turns that were complete
  std::uint64_t step = 0;    ///< kCommand and kLetGo: step of the scene played then
  std::uint32_t device_id = 0;
  std::uint8_t bound = 0;  ///< kReach: a msg::ReachBound; kLetGo: a PassedBound
  bool is_supported = true;
  // Fields of a sample, as in its message.
  std::uint64_t epoch = 0;
  std::uint64_t sample = 0;
  std::uint64_t answered_epoch = 0;
  std::uint64_t answered_sample = 0;
  std::int64_t time_nsec = 0;
  std::uint32_t axis_count = 0;
  double work_j = 0.0;
  std::array<double, msg::MAX_AXES> value{};  ///< values of a sample or a bound
  std::shared_ptr<const RequestSource> command;
};

/// A row of inputs that one thread, the loop, fills and another one empties. Real time: the side of
/// the loop takes no lock and allocates nothing; what finds no room is counted, and its number is
/// missing.
class InputLog {
 public:
  static constexpr std::size_t kRoom = 8192;  ///< inputs

  InputLog();

  // Loop.
  void sample(const msg::GesturePositions& sample, bool is_supported,
              const DeviceReach& reach) noexcept;
  void sample(const msg::GestureForces& sample, bool is_supported,
              const DeviceReach& reach) noexcept;
  /// A request that was executed. One without a source leaves nothing behind.
  void command(const Request& request) noexcept;
  void hold() noexcept;
  void repeat(std::uint32_t device_id) noexcept;
  void let_go(PassedBound bound, std::uint64_t step) noexcept;
  /// The runner has done a turn.
  void end_turn() noexcept { turns_.store(turn() + 1, std::memory_order_release); }
  /// True when the log is half full, and must be emptied soon.
  bool is_half_full() const noexcept;

  // The other thread.
  /// Turns that are complete. Whoever asks before take() finds all inputs of these turns.
  std::uint64_t turns() const noexcept { return turns_.load(std::memory_order_acquire); }
  /// The oldest input not yet taken; false when there is none.
  bool take(InputRecord& record) noexcept;
  /// Inputs that found no room.
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  struct KnownReach {
    std::uint32_t device_id = 0;
    DeviceReach reach;
    bool is_known = false;
  };
  static constexpr std::size_t kDevices = 32;  // whose reach is remembered

  std::uint64_t turn() const noexcept { return turns_.load(std::memory_order_relaxed); }
  /// Where the next input is written; nullptr when there is no room.
  InputRecord* next(InputRecord::Kind kind) noexcept;
  void push() noexcept {
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  void record_reach(std::uint32_t device_id, const DeviceReach& reach) noexcept;
  template <class Sample>
  void record_sample(InputRecord::Kind kind, const Sample& sample, bool is_supported,
                     const DeviceReach& reach, double work_j,
                     const std::array<double, msg::MAX_AXES>& value) noexcept;

  std::vector<InputRecord> records_;
  std::array<KnownReach, kDevices> reaches_;  // of the loop
  std::size_t next_reach_ = 0;                // likewise
  std::uint64_t number_ = 1;                  // likewise
  std::atomic<std::uint64_t> head_{0};        // inputs written
  std::atomic<std::uint64_t> tail_{0};        // inputs taken
  std::atomic<std::uint64_t> turns_{0};
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace cordis::sim
