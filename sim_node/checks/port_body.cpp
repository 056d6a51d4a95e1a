// sim_node/checks/port_body.cpp
#include "sim_node/checks/port_body.h"

#include <algorithm>
#include <vector>

namespace cordis::sim {
namespace {

using engine::Vec3;
using plan::PortLoad;

/// The viscosity that brakes the centre of a body [N s/m].
double outer_viscosity(const plan::LiaisonGraph& graph, const scene::Port& port, bool least) {
  std::vector<bool> is_inside(graph.inverse_mass.size());
  double sum = 0.0;
  for (const scene::BodyMass& mass : port.body) {
    is_inside[mass.mat] = true;
    sum += graph.medium_viscosity[mass.mat];
  }
  for (const plan::Edge& edge : graph.edges) {
    if (is_inside[edge.mat_a] == is_inside[edge.mat_b] || (least && !edge.bounded)) continue;
    if (edge.liaison.kind == engine::LiaisonKind::kBend) continue;  // its edges bound it from above
    sum += edge.viscosity;
  }
  return sum;  // contacts may end
}

template <class LoadOf>
PortLoad load_of_body(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                      const scene::Port& port, bool least, LoadOf load_of) {
  // The limits take K + w Z / dt of a mass, with w = 2 or 4.
  const double rate = 1.0 / scene.network.step;
  PortLoad load;
  load.viscosity = outer_viscosity(graph, port, least);
  for (const double weight : {2.0, 4.0}) {
    for (const scene::BodyMass& part : port.body) {
      const PortLoad own = load_of(graph, part.mat);
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
  if (port.body.empty()) return plan::port_load(graph, port.mat);
  return load_of_body(graph, scene, port, /*least=*/false, plan::port_load);
}

PortLoad min_load_of(const plan::LiaisonGraph& graph, const scene::Scene& scene,
                     const scene::Port& port) {
  if (port.body.empty()) return plan::min_port_load(graph, port.mat);
  return load_of_body(graph, scene, port, /*least=*/true, plan::min_port_load);
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

void push(engine::World& world, const scene::Port& port, const Vec3& force) noexcept {
  if (port.body.empty()) {
    world.set_external_force(port.mat, force);
    return;
  }
  for (const scene::BodyMass& part : port.body) {
    world.set_external_force(part.mat, part.share * force);
  }
}

}  // namespace cordis::sim
