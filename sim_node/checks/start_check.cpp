// sim_node/checks/start_check.cpp
#include "sim_node/checks/start_check.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "node/assert.h"
#include "sim_node/checks/overlap_check.h"
#include "sim_node/checks/short_text.h"
#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/variables.h"
#include "sim_node/plan/rate.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/table_pulse.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

using engine::NetworkDescription;

/// The way of two balls in the first step, over their diameter, above which they are warned of.
constexpr double kThrown = 0.1;

/// The two MATs of a liaison that its law pushes apart the most for their masses.
struct Overlap {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double distance = 0.0;  // [m]
  double force = 0.0;     // [N]
  double way = 0.0;       // in the first step, both together [m]
};

double inverse_mass(const NetworkDescription& network, std::uint32_t mat) {
  const engine::Mat& matter = network.mats[mat];
  return matter.kind == engine::MatKind::kMass ? 1.0 / matter.mass : 0.0;
}

/// The law of the start, if it is Lennard-Jones.
const engine::LennardJones* law_at_start(const engine::StateMachine& state_machine) {
  return std::get_if<engine::LennardJones>(&state_machine.states[state_machine.start].elasticity);
}

void consider(const NetworkDescription& network, const engine::LennardJones& law, std::uint32_t a,
              std::uint32_t b, double distance, Overlap& worst) {
  if (!(distance > 0.0) || distance >= law.diameter) return;
  const double force = -engine::elastic_tension(law, {distance, distance});
  const double way =
      force * network.step * network.step * (inverse_mass(network, a) + inverse_mass(network, b));
  if (way > worst.way) worst = {a, b, distance, force, way};
}

void warn_of(const scene::Scene& scene, const Overlap& worst, const engine::LennardJones& law,
             engine::LiaisonId liaison, config::Problems& problems) {
  if (!(worst.way > kThrown * law.diameter)) return;
  const scene::Called called = scene::call_liaison(scene, liaison);
  problems.warning(called.place,
                   scene::call_mat(scene, worst.mat_a).name + " and " +
                       scene::call_mat(scene, worst.mat_b).name + " start " +
                       short_text(worst.distance) + " m apart, and " + called.name +
                       ", whose diameter is " + short_text(law.diameter) + " m, pushes them with " +
                       short_text(worst.force) + " N: " + short_text(worst.way) +
                       " m in the first step",
                   "start them at least a diameter apart");
}

void warn_of_no_direction(const scene::Scene& scene, std::uint32_t mat_a, std::uint32_t mat_b,
                          engine::LiaisonId liaison, config::Problems& problems) {
  const scene::Called called = scene::call_liaison(scene, liaison);
  problems.warning(called.place,
                   scene::call_mat(scene, mat_a).name + " and " +
                       scene::call_mat(scene, mat_b).name + " start at the same point, so " +
                       called.name +
                       " has no direction between them and exerts no force, although its rest "
                       "length is not 0",
                   "move one of them a little to the side on which it shall be");
}

/// A pair has a direction only where its members are apart, in 1-D too.
void check_coincidence(const scene::Scene& scene, const plan::StartPairs& near,
                       const engine::SetLiaison& set, engine::LiaisonId liaison,
                       config::Problems& problems) {
  if (!near.at_one_point()) return;
  const std::uint32_t mat_a = plan::mat_of(set, near.at_one_point()->member_a);
  const std::uint32_t mat_b = plan::mat_of(set, near.at_one_point()->member_b);
  if (plan::rest_length_of(scene.network, set, mat_a, mat_b) == 0.0) return;
  warn_of_no_direction(scene, mat_a, mat_b, liaison, problems);
}

/// The law of the start, if it asks for variables: so does one whose rest length is a formula.
const engine::Expression* formula_at_start(const engine::StateMachine& machine) {
  const auto* law = std::get_if<engine::Expression>(&machine.states[machine.start].elasticity);
  return law != nullptr && engine::asks_for_variable(law->program) ? law : nullptr;
}

/// Warns of the first link whose ends coincide, in 2-D and 3-D, and whose formula has a tension there.
void check_formulas(const scene::Scene& scene, config::Problems& problems) {
  const NetworkDescription& network = scene.network;
  std::vector<double> variables;
  for (std::uint32_t l = 0; l < network.state_links.size(); ++l) {
    const engine::StateLink& link = network.state_links[l];
    const auto* law = formula_at_start(network.state_machines[link.state_machine]);
    if (network.dimension == 1 || law == nullptr || link.rest_length != 0.0) continue;
    engine::LawPoint point = plan::start_point(network, link);
    if (point.distance != 0.0) continue;
    if (variables.empty()) {
      const engine::World world(std::make_shared<const engine::Network>(network));
      variables.resize(network.variables.size());
      engine::read_variables(network.variables, world, variables);
    }
    point.variables = variables.data();
    if (engine::elastic_tension(*law, point) == 0.0) continue;
    warn_of_no_direction(scene, link.mat_a, link.mat_b, {engine::LiaisonKind::kStateLink, l},
                         problems);
    return;
  }
}

void check_overlaps(const scene::Scene& scene, config::Problems& problems) {
  const NetworkDescription& network = scene.network;
  for (std::uint32_t s = 0; s < network.sets.size(); ++s) {
    const engine::SetLiaison& set = network.sets[s];
    const auto* law = law_at_start(network.state_machines[set.state_machine]);
    const bool overlaps = set.rest_length != 0.0 || engine::acts_on_surfaces(network, set);
    if (law == nullptr && !overlaps) continue;
    const plan::StartPairs near(network, set);
    check_overlap(scene, near, s, problems);
    check_coincidence(scene, near, set, {engine::LiaisonKind::kSet, s}, problems);
    if (law == nullptr) continue;
    Overlap worst;
    for (const plan::StartPair& pair : near.pairs()) {
      consider(network, *law, plan::mat_of(set, pair.member_a), plan::mat_of(set, pair.member_b),
               pair.distance, worst);
    }
    warn_of(scene, worst, *law, {engine::LiaisonKind::kSet, s}, problems);
  }
  for (std::uint32_t l = 0; l < network.state_links.size(); ++l) {
    const engine::StateLink& link = network.state_links[l];
    const auto* law = law_at_start(network.state_machines[link.state_machine]);
    if (law == nullptr) continue;
    Overlap worst;
    const double distance =
        (network.mats[link.mat_b].position - network.mats[link.mat_a].position).norm();
    consider(network, *law, link.mat_a, link.mat_b, distance, worst);
    warn_of(scene, worst, *law, {engine::LiaisonKind::kStateLink, l}, problems);
  }
}

/// True where x(n+1) = x(n) + (x(n) - x(n-1)) + g dt^2 rounds to x(n) for a mass at rest.
bool swallows_gravity(const NetworkDescription& network, const engine::Mat& mat) {
  if (mat.kind != engine::MatKind::kMass) return false;
  const engine::Vec3 fall = network.gravity_on(mat) * (network.step * network.step);
  for (int axis = 0; axis < network.dimension; ++axis) {
    if (fall[axis] != 0.0 && mat.position[axis] + fall[axis] == mat.position[axis]) return true;
  }
  return false;
}

void check_gravity(const scene::Scene& scene, config::Problems& problems) {
  const NetworkDescription& network = scene.network;
  // The others carry the way of each step to the next one.
  if (network.integrator != engine::IntegratorKind::kImplicit) return;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
    const engine::Mat& mat = network.mats[i];
    if (!swallows_gravity(network, mat)) continue;
    const scene::Called called = scene::call_mat(scene, i);
    const double fall = (network.gravity_on(mat) * (network.step * network.step)).norm();
    problems.warning(called.place,
                     called.name + " never begins to fall: " + short_text(fall) +
                         " m a step are less than half of what a position of " +
                         short_text(mat.position.norm()) + " m is rounded to",
                     "a place nearer to the origin, a lower rate_hz, or the integrator cordis");
    return;
  }
}

/// A table is taken at the steps alone: between two of them a pulse is lost.
void check_pulses(const scene::Scene& scene, config::Problems& problems) {
  const auto pulse = plan::narrowest_pulse(scene.network);
  constexpr double kRounding = 1e-9;
  if (!pulse || pulse->width * scene.step_rate_hz >= 1.0 - kRounding) return;
  const scene::Called called = scene::call_mat(scene, scene.network.drives[pulse->drive].mat);
  const double needed = plan::multiple_from(1.0 / pulse->width, scene.gesture_rate_hz);
  problems.warning(called.place,
                   "'driven' of " + called.name + " has a pulse of " + short_text(pulse->width) +
                       " s at " + config::number_text(pulse->time) + " s, shorter than a step of " +
                       short_text(scene.network.step) + " s: it may be lost, in whole or in part",
                   needed <= scene::kHighestStepRate
                       ? "a rate_hz of " + config::number_text(needed) + " meets it"
                       : "make it longer and as much lower");
}

}  // namespace

void check_start(const scene::Scene& scene, config::Problems& problems) {
  CORDIS_ASSERT(scene.network.step > 0.0);
  check_overlaps(scene, problems);
  check_formulas(scene, problems);
  check_gravity(scene, problems);
  check_pulses(scene, problems);
}

}  // namespace cordis::sim
