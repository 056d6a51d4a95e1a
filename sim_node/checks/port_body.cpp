// sim_node/checks/port_body.cpp
#include "sim_node/checks/port_body.h"

#include <algorithm>
#include <vector>

#include "node/assert.h"

namespace cordis::sim {
namespace {

using engine::Vec3;
using plan::LoadBound;
using plan::PortLoad;

/// @return true if the damper of this edge is always there, and its outer end does not move along
bool surely_damps(const plan::LiaisonGraph& graph, const plan::Edge& edge, std::uint32_t outer) {
  return edge.bounded && edge.liaison.kind == engine::LiaisonKind::kLink &&
         graph.inverse_mass[outer] == 0.0;
}

/// Viscosity on each mass of a body from outside [N s/m], in their order.
std::vector<double> outer_viscosities(const plan::LiaisonGraph& graph, const scene::Port& port,
                                      LoadBound bound) {
  std::vector<bool> is_inside(graph.inverse_mass.size());
  std::vector<double> of_mat = graph.medium_viscosity;
  for (const plan::ForceBound& force : graph.forces) {
    if (bound == LoadBound::kMax) of_mat[force.mat] += force.viscosity;
  }
  for (const scene::BodyMass& mass : port.body) is_inside[mass.mat] = true;
  for (const plan::Edge& edge : graph.edges) {
    if (is_inside[edge.mat_a] == is_inside[edge.mat_b]) continue;
    if (edge.liaison.kind == engine::LiaisonKind::kBend) continue;  // its edges bound it from above
    const bool is_a = is_inside[edge.mat_a];
    if (bound == LoadBound::kMin && !surely_damps(graph, edge, is_a ? edge.mat_b : edge.mat_a))
      continue;
    of_mat[is_a ? edge.mat_a : edge.mat_b] += edge.viscosity;
  }
  std::vector<double> viscosities;  // contacts may end
  for (const scene::BodyMass& mass : port.body) viscosities.push_back(of_mat[mass.mat]);
  return viscosities;
}

/// The viscosity that damps the centre of a body [N s/m]. At least: with V = sum s_i v_i, no motion
/// loses less than V^2 / sum(s_i^2 / Z_i) [Cauchy and Schwarz]. At most: all masses at one speed.
double viscosity_of_centre(const plan::LiaisonGraph& graph, const scene::Port& port,
                           LoadBound bound) {
  const std::vector<double> outer = outer_viscosities(graph, port, bound);
  double sum = 0.0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const double share = port.body[i].share;
    if (bound == LoadBound::kMax) {
      sum += outer[i];
    } else if (outer[i] > 0.0) {
      sum += share * share / outer[i];
    } else {
      return 0.0;
    }
  }
  return bound == LoadBound::kMax || sum == 0.0 ? sum : 1.0 / sum;
}

PortLoad load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                 const scene::Port& port, LoadBound bound) {
  const std::vector<PortLoad> loads = plan::port_loads(graph, bound);
  if (port.body.empty()) return loads[port.mat];
  // The limits take K + w Z / dt of a mass, with w = 2 or 4.
  const double rate = 1.0 / scene.network.step;
  PortLoad load;
  load.viscosity = viscosity_of_centre(graph, port, bound);
  for (const double weight : {2.0, 4.0}) {
    for (const scene::BodyMass& part : port.body) {
      const PortLoad& own = loads[part.mat];
      const double number = (own.stiffness + weight * rate * own.viscosity) / part.share;
      load.stiffness = std::max(load.stiffness, number - weight * rate * load.viscosity);
    }
  }
  return load;
}

}  // namespace

double mass_of(const scene::Scene& scene, const scene::Port& port) {
  if (port.body.empty()) return scene.network.mats[port.mat].mass;
  double sum = 0.0;
  for (const scene::BodyMass& part : port.body) sum += scene.network.mats[part.mat].mass;
  return sum;
}

PortLoad max_load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                     const scene::Port& port) {
  return load_of(graph, scene, port, LoadBound::kMax);
}

PortLoad min_load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                     const scene::Port& port) {
  return load_of(graph, scene, port, LoadBound::kMin);
}

Vec3 position_of(const engine::World& world, const scene::Port& port) noexcept {
  if (port.body.empty()) return world.position(port.mat);
  Vec3 sum = Vec3::Zero();
  for (const scene::BodyMass& part : port.body) sum += part.share * world.position(part.mat);
  return sum;
}

Vec3 velocity_of(const engine::World& world, const scene::Port& port) noexcept {
  if (port.body.empty()) return world.velocity(port.mat);
  Vec3 sum = Vec3::Zero();
  for (const scene::BodyMass& part : port.body) sum += part.share * world.velocity(part.mat);
  return sum;
}

void apply_force(engine::World& world, const scene::Port& port, const Vec3& force) noexcept {
  CORDIS_ASSERT(port.role == scene::Role::kLiaison);
  if (port.body.empty()) {
    world.set_external_force(port.mat, force);
    return;
  }
  for (const scene::BodyMass& part : port.body) {
    world.set_external_force(part.mat, part.share * force);
  }
}

}  // namespace cordis::sim
