// sim_node/checks/rate_check.cpp
#include "sim_node/checks/rate_check.h"

#include <cstdio>
#include <string>

#include "node/config/mapping_reader.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/plan/reference/trial_run.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

constexpr double kManyTolerances = 10.0;  // a larger error of one body is a warning

}  // namespace

std::optional<plan::RateSelection> select_rate(scene::Scene& scene, config::Problems& problems) {
  if (!scene.accuracy) return {};
  const scene::Accuracy& asked = *scene.accuracy;
  plan::RateSelection selection = plan::select_rate(
      scene.network,
      {asked.tolerance, asked.band_hz, asked.contact_energy, asked.over_s, scene::kHighestStepRate},
      scene.gesture_rate_hz,
      scene.integrator_is_open ? plan::integrators_for(scene.network)
                               : std::vector<std::string>{to_string(scene.network.integrator)},
      !scene.ports.empty());
  config::Place place = asked.place;
  if (selection.unstable) {
    place = scene::call_liaison(scene, selection.unstable->liaison).place;
    selection.uncertainty += ": " + uncertainty_text(scene, *selection.unstable);
  }
  if (!selection.uncertainty.empty()) problems.warning(place, selection.uncertainty);
  if (selection.worst_body && selection.worst_body->error > kManyTolerances * asked.tolerance) {
    char error[32];
    std::snprintf(error, sizeof(error), "%.2g", selection.worst_body->error);
    problems.warning(asked.place,
                     "the tolerance is that of all motion together: what is joined to " +
                         scene::call_mat(scene, selection.worst_body->mat).name +
                         " moves by itself with an error of " + error + " of that",
                     "take a smaller tolerance, or put what travels far into a scene of its own");
  }
  const bool is_possible = selection.rate_hz <= scene::kHighestStepRate;
  if (scene.rate_is_open && !is_possible) {
    problems.error(asked.place,
                   "no rate up to " + config::number_text(scene::kHighestStepRate) +
                       " Hz keeps this: " + selection.because + " asks for " +
                       config::number_text(selection.rate_hz) + " Hz",
                   "ask for less, or write a rate_hz");
  } else if (scene.rate_is_open) {
    scene::set_step(scene, selection.rate_hz, engine::integrator_named(selection.integrator));
  } else if (scene.step_rate_hz < selection.needed_hz) {
    problems.warning(asked.place,
                     "at " + config::number_text(scene.step_rate_hz) +
                         " Hz the scene does not keep this: " + selection.because +
                         " asks for more",
                     is_possible ? "take a rate_hz of " + config::number_text(selection.rate_hz) +
                                       ", or leave rate_hz out"
                                 : "no rate_hz may be so high: ask for less");
  }
  return selection;
}

}  // namespace cordis::sim
