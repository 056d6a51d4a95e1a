// sim_node/plan/stability/start_point.cpp
#include "sim_node/plan/stability/start_point.h"

namespace cordis::plan {
namespace {

/// As expressions know it [kg].
double mass_of(const engine::Mat& mat) {
  return mat.kind == engine::MatKind::kMass ? mat.mass : 0.0;
}

engine::LawPoint point_between(const engine::NetworkDescription& network, std::uint32_t mat_a,
                               std::uint32_t mat_b, double distance, double rest_length) {
  return {distance, distance - rest_length, 0.0, mass_of(network.mats[mat_a]),
          mass_of(network.mats[mat_b])};
}

}  // namespace

double distance_at_start(const engine::NetworkDescription& network, std::uint32_t mat_a,
                         std::uint32_t mat_b) {
  const engine::Vec3 along = network.mats[mat_b].position - network.mats[mat_a].position;
  return network.dimension == 1 ? along.x() : along.norm();
}

engine::LawPoint start_point(const engine::NetworkDescription& network,
                             const engine::StateLink& link) {
  return point_between(network, link.mat_a, link.mat_b,
                       distance_at_start(network, link.mat_a, link.mat_b), link.rest_length);
}

engine::LawPoint start_point(const engine::NetworkDescription& network,
                             const engine::SetLiaison& set, const StartPair& pair) {
  const std::uint32_t mat_a = mat_of(set, pair.member_a);
  const std::uint32_t mat_b = mat_of(set, pair.member_b);
  return point_between(network, mat_a, mat_b, pair.distance,
                       rest_length_of(network, set, mat_a, mat_b));
}

}  // namespace cordis::plan
