// sim_node/run/shadow_world.h -- energy and state hash of a world, found beside its loop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reach_limit.h"
#include "sim_node/run/energy_watch.h"

namespace cordis::sim {

/// What the energy of a moment says about the bounds of a scene.
struct BoundSigns {
  bool makes_energy = false;     ///< makes_energy()
  bool is_beyond_reach = false;  ///< plan::is_beyond() its ReachLimit
  bool has_energy = true;        ///< false: the energy is no finite number
};

/// What a status reports of one moment of a world.
struct WorldFigures {
  engine::Energy energy;
  std::uint64_t step = 0;        ///< steps done
  std::uint64_t state_hash = 0;  ///< World::state_hash()
  BoundSigns signs;
};

/// Real time: O(MATs + links + pairs), no allocation; much longer than a copy of the state.
/// @param watch  takes this moment into the largest energy
WorldFigures figures_of(const engine::World& world, EnergyWatch& watch,
                        const plan::ReachLimit& reach = {}) noexcept;

/// True when the steps have made or taken more than 1 % of the largest energy that the scene has had.
/// What a scene at rest makes by rounding does not count: below 1e-20 J, and below 1e-10 of the energy of
/// gravity, which is counted from the origin.
/// @param energy  as an EnergyWatch has it; likewise below
bool is_error_large(const engine::Energy& energy) noexcept;

/// True when Energy::made_there is above a tenth of the largest energy. Small errors of each period may sum to
/// more while a hand plays on: viscosity dissipates them, and no motion grows.
bool makes_energy(const engine::Energy& energy) noexcept;

/// Real time: O(MATs + members of sets), no allocation.
/// @param energy  of the world now, as an EnergyWatch has it
BoundSigns signs_of(const engine::World& world, const engine::Energy& energy,
                    const plan::ReachLimit& reach) noexcept;

/// A second world of a network, for a thread that reads the first one now and then. The loop
/// that moves the first one copies its state, and only when the other thread has asked.
class ShadowWorld {
 public:
  /// @param reach  that is_beyond_reach is about
  explicit ShadowWorld(std::shared_ptr<const engine::Network> network,
                       plan::ReachLimit reach = {}) noexcept;

  /// From 1 on; differs from that of every other one in this process. Any thread.
  std::uint64_t id() const noexcept { return id_; }

  /// The loop, between two steps: copies the state if it was asked for. Real time: no allocation.
  /// @param largest_kinetic  seen so far by a KineticWatch of this world [J]
  void hand_over(const engine::World& world, double largest_kinetic = 0.0) noexcept;

  /// The other thread: asks for a copy and reads its figures. Makes room the first time.
  /// @param patience  wait for the loop at most; a copy that comes later serves the next call
  std::optional<WorldFigures> read(std::chrono::milliseconds patience);

 private:
  enum class Copy : std::uint8_t { kNone, kAsked, kTooLarge, kThere };

  std::uint64_t id_;
  std::shared_ptr<const engine::Network> network_;
  plan::ReachLimit reach_;
  std::unique_ptr<engine::World> world_;  // made by the first read()
  EnergyWatch watch_;                     // of all that was read
  std::vector<double> room_;              // of the loop while a copy is asked for
  std::size_t value_count_ = 0;           // likewise; of a state that is too large for the room
  std::uint64_t step_ = 0;                // likewise
  double largest_kinetic_ = 0.0;          // likewise [J]
  std::atomic<Copy> copy_{Copy::kNone};
};

}  // namespace cordis::sim
