// sim_node/checks/overlap_check.cpp
#include "sim_node/checks/overlap_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "node/assert.h"
#include "node/config/count_text.h"
#include "sim_node/checks/short_text.h"
#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/surface.h"
#include "sim_node/engine/laws/quadrature.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

using engine::LawPoint;
using engine::LinkState;
using engine::NetworkDescription;
using engine::Quantity;

/// What a state pulls at rest [N].
double tension_of(const LinkState& state, const LawPoint& point) {
  const double law = engine::elastic_tension(state.elasticity, point);
  double tension = state.stiffness * point.elongation + (std::isfinite(law) ? law : 0.0);
  if (!state.pulls) tension = std::min(tension, 0.0);
  if (!state.pushes) tension = std::max(tension, 0.0);
  return std::clamp(tension, -state.force_limit, state.force_limit);
}

/// What a state stores from a point up to the rest length [J], with what it is clamped to.
double energy_of(const LinkState& state, const LawPoint& point) {
  const engine::Quadrature push([&](double elongation) {
    LawPoint here = point;
    here.distance += elongation - point.elongation;
    here.elongation = elongation;
    return -tension_of(state, here);
  });
  return std::max(push.integral(point.elongation, 0.0), 0.0);
}

engine::LinkQuantities quantities_of(const LinkState& state, const LawPoint& point) {
  engine::LinkQuantities quantities{};
  const auto put = [&quantities](Quantity quantity, double value) {
    quantities[static_cast<std::size_t>(quantity)] = value;
  };
  put(Quantity::kDistance, point.distance);
  put(Quantity::kElongation, point.elongation);
  put(Quantity::kRestLength, point.distance - point.elongation);
  put(Quantity::kForce, tension_of(state, point));
  put(Quantity::kMassA, point.mass_a);
  put(Quantity::kMassB, point.mass_b);
  return quantities;
}

/// The state that the exits lead a pair to from the start; null where they give it another rest length or
/// lead it round. Exits that ask for variables do not hold.
const LinkState* state_at(const engine::StateMachine& machine, const LawPoint& point) {
  std::uint32_t present = machine.start;
  for (std::size_t n = 0; n <= machine.states.size(); ++n) {
    const LinkState& state = machine.states[present];
    const engine::LinkQuantities quantities = quantities_of(state, point);
    const auto begin = machine.exits.begin();
    const auto end = begin + state.last_exit;
    const auto exit = std::find_if(begin + state.first_exit, end, [&](const auto& each) {
      return !asks_for_variable(each.when) && engine::value_of(each.when, quantities) != 0.0;
    });
    if (exit == end) return &state;
    if (exit->rest != engine::RestRule::kKeep) return nullptr;
    present = exit->target;
  }
  return nullptr;
}

/// The speed at which the lighter one leaves a pair [m/s]; 0 where nothing is pushed.
double speed_of(const engine::StateMachine& machine, const LawPoint& point) {
  if (point.elongation >= 0.0 || (point.mass_a == 0.0 && point.mass_b == 0.0)) return 0.0;
  const LinkState* const state = state_at(machine, point);
  if (state == nullptr || std::holds_alternative<engine::LennardJones>(state->elasticity))
    return 0.0;
  const double energy = energy_of(*state, point);
  const double lighter = std::min(point.mass_a, point.mass_b);
  const double heavier = std::max(point.mass_a, point.mass_b);
  if (lighter == 0.0) return std::sqrt(2.0 * energy / heavier);
  return std::sqrt(2.0 * energy * heavier / (lighter * (lighter + heavier)));
}

/// True if a surface has a hollow when it is written with both sides.
bool could_be_hollow(const engine::Surface& surface) {
  const bool is_body =
      surface.kind == engine::SurfaceKind::kBox || surface.kind == engine::SurfaceKind::kCylinder;
  return is_body && !surface.both_sides;
}

/// What `check` says of the worst pair.
struct Thrown {
  std::uint32_t mat_a = 0;
  std::uint32_t mat_b = 0;
  double nearer = 0.0;    // than the rest length [m]
  double speed = 0.0;     // [m/s]
  std::size_t count = 0;  // of pairs faster than kThrownSpeed
};

void warn_of(const scene::Scene& scene, const Thrown& worst, std::uint32_t set,
             config::Problems& problems) {
  const scene::Called called =
      scene::call_liaison(scene, engine::LiaisonId{engine::LiaisonKind::kSet, set});
  const std::string a = scene::call_mat(scene, worst.mat_a).name;
  const std::string b = scene::call_mat(scene, worst.mat_b).name;
  const engine::Surface* const surface = engine::surface_of(scene.network, worst.mat_a);
  const std::string count =
      worst.count == 1 ? "" : ", the worst of " + config::count_text(worst.count, "pair");
  std::string hint = surface == nullptr ? "start them farther apart" : "start it farther out";
  if (surface != nullptr && could_be_hollow(*surface))
    hint += ", or write sides: both for a body that is hollow";
  problems.warning(called.place,
                   called.name + " throws " +
                       (surface == nullptr ? a + " and " + b + " apart" : b + " out of " + a) +
                       " at " + short_text(worst.speed) + " m/s: they start " +
                       short_text(worst.nearer) + " m nearer than their rest length" + count,
                   hint + ", or let the scene 'settle'");
}

}  // namespace

void check_overlap(const scene::Scene& scene, const plan::StartPairs& near, std::uint32_t set,
                   config::Problems& problems) {
  const NetworkDescription& network = scene.network;
  CORDIS_ASSERT(set < network.sets.size());
  const engine::SetLiaison& liaison = network.sets[set];
  const engine::StateMachine& machine = network.state_machines[liaison.state_machine];
  Thrown worst;
  for (const plan::StartPair& pair : near.pairs()) {
    const LawPoint point = plan::start_point(network, liaison, pair);
    const double speed = speed_of(machine, point);
    if (!(speed > kThrownSpeed)) continue;
    const std::size_t count = worst.count + 1;
    if (speed > worst.speed) {
      worst = {plan::mat_of(liaison, pair.member_a), plan::mat_of(liaison, pair.member_b),
               -point.elongation, speed, 0};
    }
    worst.count = count;
  }
  if (worst.count > 0) warn_of(scene, worst, set, problems);
}

}  // namespace cordis::sim
