// sim_node/engine/integrators/modal_integrator.h -- linear networks in 1 dimension by their modes.
#pragma once

#include <cstddef>
#include <vector>

#include "sim_node/engine/integrators/integrator.h"
#include "sim_node/engine/integrators/modal_block.h"

namespace cordis::engine {

/// Moves all masses by the modes of a ModalBlock, exactly and at any step. What is not linear, and
/// what is tied to a port, pushes them. The forces of state links, sets, Maxwell elements, links to
/// ports and from outside are computed as `cordis` does. They are held for the step. Only the MATs
/// they act on are found in each step; all others when they are asked for. Such a force must not be
/// stiffer than ModalBlock::max_stiffness.
///
/// World::link_force knows nothing of the links in the block. The account is that of `cordis`, and
/// closes to rounding.
class ModalIntegrator final : public Integrator {
 public:
  explicit ModalIntegrator(const NetworkDescription& network);

  void start(WorldState& world) noexcept override;
  Moved step(WorldState& world) noexcept override;
  Energy energy(WorldState& world) const noexcept override;
  double kinetic_energy(const WorldState&) const noexcept override {
    return block_.kinetic_energy();
  }
  void show(WorldState& world, std::uint32_t mat) const noexcept override;
  void show_all(WorldState& world) const noexcept override;

  void serialize(Archive& archive) override;
  void restored(WorldState& world) noexcept override;

 private:
  void drive(std::uint32_t mat);
  double energy_of_port_links(const WorldState& world) const noexcept;

  ModalBlock block_;
  const ModalKernel* kernel_ = nullptr;
  std::vector<double> start_;              // position of each MAT at step 0 [m]
  std::vector<std::uint32_t> port_links_;  // linear links to ports
  std::vector<std::uint32_t> ends_;        // of what is not in the block
  std::vector<std::uint32_t> driven_;      // MATs that forces act on
  std::vector<std::uint8_t> is_end_;       // by MAT
  std::vector<std::uint8_t> is_driven_;    // by MAT
  std::vector<std::uint8_t> is_mass_;      // by MAT
  std::vector<ModeDrive> drives_;          // of driven_
  std::ptrdiff_t own_driven_ = 0;          // of driven_, whatever is held from outside
};

}  // namespace cordis::engine
