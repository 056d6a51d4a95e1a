// sim_node/stability_check.cpp
#include "sim_node/stability_check.h"

#include <cmath>
#include <string>

#include "sim_node/plan/plan.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {

void check_stability(const scene::Scene& scene, bool force, config::Problems& problems) {
  const plan::Stability stability =
      plan::stability_of(scene.network, plan::liaison_graph(scene.network));
  if (stability.holds()) return;

  const plan::StepBound& bound = stability.certified;
  const scene::Called liaison = scene::call_liaison(scene, bound.liaison);
  const long rate = std::lround(scene.step_rate_hz);
  const double per_tick = scene.gesture_rate_hz;
  const double stable_rate = (std::floor(1.0 / (bound.step * per_tick)) + 1.0) * per_tick;
  const std::string limit =
      liaison.name + " at the mass " + scene::call_mat(scene, bound.mat).name + " sets the limit";
  const std::string hint =
      "a rate_hz of " + std::to_string(std::lround(stable_rate)) + " is stable in all of them";
  if (!stability.diverges()) {
    problems.warning(liaison.place,
                     "at " + std::to_string(rate) +
                         " Hz the scene may be unstable in some poses or states: " + limit,
                     hint);
  } else if (force) {
    problems.warning(liaison.place,
                     "at " + std::to_string(rate) + " Hz the scene is unstable: " + limit, hint);
  } else {
    problems.error(liaison.place,
                   "at " + std::to_string(rate) + " Hz the scene is unstable: " + limit,
                   hint + "; or run it all the same with force=true of its sim_node");
  }
}

}  // namespace cordis::sim
