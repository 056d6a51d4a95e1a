// sim_node/checks/rate_choice.cpp
#include "sim_node/checks/rate_choice.h"

#include <string>

#include "node/config/mapping_reader.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::sim {

std::optional<plan::RateSelection> select_rate(scene::Scene& scene, config::Problems& problems) {
  if (!scene.accuracy) return {};
  const scene::Accuracy& asked = *scene.accuracy;
  plan::RateSelection choice = plan::choose(
      scene.network, {asked.tolerance, asked.band_hz, asked.contact_energy, asked.over_s},
      scene.gesture_rate_hz,
      scene.integrator_is_open ? plan::integrators_for(scene.network)
                               : std::vector<std::string>{to_string(scene.network.integrator)},
      !scene.ports.empty());
  if (!choice.uncertainty.empty()) problems.warning(asked.place, choice.uncertainty);
  if (scene.rate_is_open) {
    scene::set_step(scene, choice.rate_hz, engine::integrator_named(choice.integrator));
  } else if (scene.step_rate_hz < choice.needed_hz) {
    problems.warning(
        asked.place,
        "at " + config::number_text(scene.step_rate_hz) +
            " Hz the scene does not keep this: " + choice.because + " asks for more",
        "take a rate_hz of " + config::number_text(choice.rate_hz) + ", or leave rate_hz out");
  }
  return choice;
}

}  // namespace cordis::sim
