// sim_node/checks/settling.cpp
#include "sim_node/checks/settling.h"

#include <algorithm>

#include "node/assert.h"
#include "node/config/count_text.h"
#include "sim_node/checks/short_text.h"
#include "sim_node/plan/settle.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

std::string slides_text(const scene::Scene& scene, const plan::Settled& rest) {
  if (!rest.slides_on) return {};
  return ", which slides on " + scene::call_mat(scene, *rest.slides_on).name;
}

/// What may help a scene that is still pulled after all its steps.
std::string hint_of(const scene::Scene& scene, const plan::Settled& rest) {
  const std::string name = scene::call_mat(scene, rest.pulled).name;
  const std::string larger = "write an until_n above " + short_text(rest.force);
  if (rest.falls) {
    return "nothing holds " + name +
           ": it falls. Give it a liaison or a surface to rest on, or fix it; write more steps if "
           "it still falls onto one";
  }
  if (rest.slides_on) return "let friction hold " + name + ", fix it, or " + larger;
  if (rest.comes_nearer) return "it comes nearer to rest: write more steps, or " + larger;
  return "hold " + name + " by a liaison or a surface, fix it, or " + larger;
}

/// True if contacts of the one are contacts of the other, with friction.
bool has_same_contacts(const engine::NetworkDescription& settled,
                       const engine::NetworkDescription& network, std::size_t set) {
  const engine::SetLiaison& before = settled.sets[set];
  const engine::SetLiaison& after = network.sets[set];
  return before.set_p == after.set_p && before.set_q == after.set_q &&
         rubs(network.state_machines[after.state_machine]);
}

}  // namespace

void settle(scene::Scene& scene, config::Problems& problems) {
  if (!scene.settle) return;
  CORDIS_ASSERT(scene.network.step > 0.0);
  const scene::Settle& asked = *scene.settle;
  if (plan::rest_is_open(scene.network)) {
    problems.error(asked.place,
                   "a scene whose laws or forces ask for more than time_s has no rest to settle to",
                   "leave out 'settle', or let its parameters ask for time_s alone");
    return;
  }
  const plan::Settled rest =
      plan::settle(scene.network, {asked.until, asked.max_steps, asked.has_friction});
  if (!rest.is_finite) {
    problems.error(asked.place, "the scene diverges while it settles",
                   "a higher rate_hz may hold it");
    return;
  }
  if (rest.is_rounding) {
    problems.error(
        asked.place,
        "the scene comes no nearer to rest than " + short_text(rest.force) + " N, which pull " +
            scene::call_mat(scene, rest.pulled).name,
        "positions are rounded: write an until_n of " + short_text(4.0 * rest.force) + " or more");
    return;
  }
  if (!(rest.force < asked.until)) {
    problems.error(asked.place,
                   "the scene has not come to rest in " + config::count_text(rest.steps, "step") +
                       ": " + short_text(rest.force) + " N pull " +
                       scene::call_mat(scene, rest.pulled).name + slides_text(scene, rest),
                   hint_of(scene, rest));
    return;
  }
  scene::SettledStart moved;
  moved.steps = rest.steps;
  moved.force = rest.force;
  for (std::uint32_t i = 0; i < rest.position.size(); ++i) {
    const double way = (rest.position[i] - scene.network.mats[i].position).norm();
    if (way > moved.way) {
      moved.way = way;
      moved.mat = i;
    }
    scene.network.mats[i].position = rest.position[i];
  }
  for (std::size_t s = 0; s < rest.stretches.size(); ++s)
    scene.network.sets[s].stretches = rest.stretches[s];
  scene.settled = moved;
}

void keep_settled(const scene::Scene& settled, scene::Scene& scene) {
  if (!settled.settled || settled.network.mats.size() != scene.network.mats.size()) return;
  for (std::size_t i = 0; i < scene.network.mats.size(); ++i) {
    scene.network.mats[i].position = settled.network.mats[i].position;
  }
  const std::size_t sets = std::min(settled.network.sets.size(), scene.network.sets.size());
  for (std::size_t s = 0; s < sets; ++s) {
    if (has_same_contacts(settled.network, scene.network, s))
      scene.network.sets[s].stretches = settled.network.sets[s].stretches;
  }
  scene.settled = settled.settled;
}

std::string settled_text(const scene::Scene& scene) {
  if (!scene.settled) return {};
  const scene::SettledStart& moved = *scene.settled;
  const std::string steps = config::count_text(moved.steps, "step");
  const std::string force = short_text(moved.force) + " N pull at most";
  if (moved.way == 0.0) return "was at rest: " + force;
  return "in " + steps + ": " + force + "; " + scene::call_mat(scene, moved.mat).name +
         " moved the farthest, " + short_text(moved.way) + " m";
}

}  // namespace cordis::sim
