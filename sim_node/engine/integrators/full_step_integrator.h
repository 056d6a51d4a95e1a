// sim_node/engine/integrators/full_step_integrator.h -- what integrators share whose account
// belongs to a moment.
#pragma once

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/integrators/integrator.h"

namespace cordis::engine {

/// A Integrator whose account belongs to the moment of the last forces: half of the works of a step
/// come before that moment, the others are entered with the next step.
class FullStepIntegrator : public Integrator {
 public:
  void serialize(Archive& archive) override;
  void restored(WorldState& world) noexcept final;

 protected:
  /// @param value_count  so many values are remembered
  explicit FullStepIntegrator(std::size_t value_count) : memory_(value_count, 0.0) {}

  /// Enters the works that were pending, and moves the ports.
  void begin_step(WorldState& world, StepEnergy& energy) noexcept;
  /// The forces of all liaisons, where dampers see (position - extrapolated) / dt, and those from
  /// outside.
  void find_forces(WorldState& world, const double* extrapolated, StepEnergy& energy) noexcept;
  /// The forces from outside, and the works of ports.
  void find_outer_forces(WorldState& world, StepEnergy& energy) noexcept;
  /// Puts other forces in the place of some of them. @return half of what that changes in what
  /// viscosity takes in a period [J]
  virtual double correct_forces(WorldState&) noexcept { return 0.0; }
  /// Enters one half of a loss that lies about the moment; the other is pending. In the first step,
  /// whose moment is the start, no half lies before it.
  void take_half(double half, StepEnergy& energy) noexcept;
  /// After the MATs have moved.
  void end_step(WorldState& world) noexcept;

  AlignedVector<double> memory_;
  StepEnergy pending_;    // works after the moment of the last forces
  bool started_ = false;  // a step has been done
};

}  // namespace cordis::engine
