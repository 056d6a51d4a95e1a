// sim_node/engine/integrators/integrator.h -- how a world goes from one step to the next.
#pragma once

#include <cstdint>
#include <memory>

#include "sim_node/engine/core/archive.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/matter/energy_account.h"
#include "sim_node/engine/matter/mat_array.h"

namespace cordis::engine {

struct WorldState;

/// What a step reports besides what stands in the state.
struct Moved {
  StepEnergy energy;
  std::uint32_t non_finite_mats = 0;
};

/// One of these for each Integrator: orders the evaluations of the forces and moves the MATs. The
/// links, states and sets of the world are the same for all. One call a step, so that being virtual
/// costs nothing.
class Integrator {
 public:
  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  virtual ~Integrator() = default;

  /// Takes the MATs as their constructor leaves them to step 0, and opens the account.
  virtual void start(WorldState& world) noexcept = 0;
  /// One step. Real time: no allocation, never throws.
  virtual Moved step(WorldState& world) noexcept = 0;
  /// The parameters of liaisons have changed between two steps.
  virtual void adopt(WorldState&) noexcept {}
  /// Energies and account as World::energy promises them.
  virtual Energy energy(WorldState& world) const noexcept = 0;
  /// Kinetic energy of all masses, from velocity(), or as energy() has it [J]. Real time: O(MATs), no allocation.
  virtual double kinetic_energy(const WorldState& world) const noexcept;
  /// [m/s]
  virtual Vec3 velocity(const WorldState& world, std::uint32_t mat) const noexcept;

  /// Brings a MAT, or all of them, to where they are now, if steps do not.
  virtual void show(WorldState&, std::uint32_t) const noexcept {}
  virtual void show_all(WorldState&) const noexcept {}

  /// What it remembers besides the state of the MATs.
  virtual void serialize(Archive&) {}
  /// After all of the world has been restored.
  virtual void restored(WorldState&) noexcept {}
};

/// @throws std::invalid_argument when the integrator does not take the network: see refusal_of().
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const NetworkDescription& network);

}  // namespace cordis::engine
