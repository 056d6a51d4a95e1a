// sim_node/plan/reference/trial_run.h -- one run of a network: what it costs, and how far it is
// off.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reference/input_trajectory.h"
#include "sim_node/plan/reference/reference.h"

namespace cordis::plan {

/// The integrators that may be taken for the network unasked, by the name they have in a scene:
/// those that take it, `modal` only where its modes are found at once.
std::vector<std::string> integrators_for(engine::NetworkDescription network);
/// Evaluations of all forces in one step of an integrator.
int evaluations_per_step(const std::string& integrator);

/// All integrators, by the name they have in a scene.
std::vector<std::string> integrator_names();
/// Why an integrator does not take a network; empty when it does.
std::string refusal_of(engine::NetworkDescription network, const std::string& integrator);

/// A network at a rate under an input trajectory.
class TrajectoryRun {
 public:
  /// @throws std::invalid_argument when the engine does not take the network, or the integrator
  ///         not this network
  TrajectoryRun(engine::NetworkDescription network, const std::string& integrator, double rate_hz,
                const InputTrajectory& trajectory);

  /// So many steps, or until a position is not finite. @return whether all still are
  bool advance(std::uint64_t steps);
  const engine::World& world() const noexcept { return world_; }

 private:
  const InputTrajectory& trajectory_;
  engine::World world_;
};

struct TrialResult {
  std::string integrator;
  double rate_hz = 0.0;
  double evaluations_per_s = 0.0;   ///< evaluations of all forces, per simulated second
  double nsec_per_s = 0.0;          ///< processor time, per simulated second
  double instructions_per_s = 0.0;  ///< per simulated second; 0 where they cannot be counted
  double error = 0.0;         ///< root of the mean square of position errors, over the amplitude
  double energy_error = 0.0;  ///< in the mean kinetic energy after the reference has diverged,
                              ///< relative
  bool blown_up = false;
  double blown_up_at = 0.0;  ///< [s]
};

/// Runs it to the end of the reference. It is compared at the moments that are for its rate.
/// @throws as TrajectoryRun
TrialResult try_out(const engine::NetworkDescription& network, const std::string& integrator,
                    double rate_hz, const InputTrajectory& trajectory, const Reference& reference);

}  // namespace cordis::plan
