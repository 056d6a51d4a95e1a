// sim_node/plan/reference/reference_integrator.h -- what a network really does, as nearly as double
// numbers resolve.
#pragma once

#include <cstdint>

#include "sim_node/plan/reference/ode_system.h"

namespace cordis::plan {

/// Follows the equations of motion with steps that adapt to them, and finds the moments at which
/// links change their state. Offline: slow, and allocates.
///
/// Extrapolation of the modified midpoint rule in up to 8 columns (Gragg, Bulirsch, Stoer), of
/// order 16; the error of a step is the difference of the last two. Source: Hairer, Norsett,
/// Wanner, Solving Ordinary Differential Equations I, II.9. With states no step is longer than that
/// of the network, so that a condition which holds for as long is not overlooked.
class ReferenceIntegrator {
 public:
  /// @param tolerance  of a step, relative to the largest position, velocity and internal force
  explicit ReferenceIntegrator(engine::NetworkDescription network, double tolerance = 1e-13);

  /// Goes on to a time [s], not before the present one.
  /// @throws std::runtime_error when a step becomes shorter than the numbers resolve
  void advance_to(double time);

  /// The velocity of a port [m/s], or the force from outside [N] on a mass, from now on.
  void set_velocity(std::uint32_t mat, const engine::Vec3& velocity);
  void hold_force(std::uint32_t mat, const engine::Vec3& force) { system_.hold_force(mat, force); }

  double time() const noexcept { return time_; }
  engine::Vec3 position(std::uint32_t mat) const { return system_.position(values_, mat); }
  engine::Vec3 velocity(std::uint32_t mat) const { return system_.velocity(values_, mat); }
  std::uint32_t state_of(std::uint32_t state_link) const { return system_.state_of(state_link); }
  std::uint64_t force_evaluations() const noexcept { return evaluations_; }
  std::uint64_t state_changes() const noexcept { return changes_; }

 private:
  using Values = OdeSystem::Values;

  struct StepAttempt {
    double error = 0.0;  // over the tolerance
    int columns = 0;     // that it took
  };

  /// One step of this length from the present values.
  StepAttempt try_step(double step, Values& after);
  /// Difference of two values after a step, over the tolerance.
  double difference(const Values& after, const Values& lower) const;
  void midpoint(double step, int parts, Values& after);
  void locate_change(double step, Values& after);
  void accept(double step, Values& after);

  OdeSystem system_;
  double tolerance_;
  double time_ = 0.0;
  double next_step_ = 0.0;
  double longest_step_;
  Values values_;
  Values rate_;
  Values first_;
  Values second_;
  std::vector<Values> columns_;
  std::uint64_t evaluations_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace cordis::plan
