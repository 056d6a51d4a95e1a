// sim_node/checks/planned_scene.cpp
#include "sim_node/checks/planned_scene.h"

#include <utility>

#include "sim_node/checks/rate_check.h"
#include "sim_node/checks/settling.h"
#include "sim_node/checks/start_check.h"
#include "sim_node/checks/start_state.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::sim {

PlannedScene plan_scene(const std::string& file, const config::Place& referrer,
                        config::Problems& problems) {
  return plan_scene(scene::load_scene(file, problems, referrer), problems);
}

PlannedScene plan_scene(scene::Scene scene, config::Problems& problems) {
  PlannedScene planned{std::move(scene), {}};
  if (problems.has_errors()) return planned;
  planned.scene = plan::reduce(std::move(planned.scene), problems);
  if (!problems.has_errors()) planned.rate = select_rate(planned.scene, problems);
  if (!problems.has_errors()) settle(planned.scene, problems);
  if (!problems.has_errors()) read_start_state(planned.scene, problems);
  if (!problems.has_errors()) check_start(planned.scene, problems);
  return planned;
}

}  // namespace cordis::sim
