// cli/bench/bench_networks.cpp
#include "cli/bench/bench_networks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::cli {

using engine::Mat;
using engine::MatKind;
using engine::NetworkDescription;
using engine::Vec3;

NetworkDescription square_net(int dimension, std::uint32_t side) {
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const std::uint32_t row = i / side;
    const std::uint32_t column = i % side;
    Mat mat;
    mat.mass = 0.01;
    mat.position = dimension == 1 ? Vec3(0.001 * (row * column % 7), 0.0, 0.0)
                                  : Vec3(0.01 * column, 0.01 * row, 0.0);
    network.mats.push_back(mat);
  }
  const double rest = dimension == 1 ? 0.0 : 0.0099;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    if (i % side + 1 < side) network.links.push_back({i, i + 1, 100.0, 0.01, rest});
  }
  for (std::uint32_t i = 0; i + side < side * side; ++i)
    network.links.push_back({i, i + side, 100.0, 0.01, rest});
  return network;
}

NetworkDescription strings(std::uint32_t masses) {
  constexpr std::uint32_t kMasses = 200;
  NetworkDescription network;
  network.dimension = 3;
  network.step = 1e-3;
  for (std::uint32_t string = 0; string < std::max(1u, masses / kMasses); ++string) {
    const auto first = static_cast<std::uint32_t>(network.mats.size());
    for (std::uint32_t i = 0; i < kMasses + 2; ++i) {
      Mat mat;
      mat.kind = i == 0 || i == kMasses + 1 ? MatKind::kFixed : MatKind::kMass;
      mat.mass = 0.001;
      mat.position = Vec3(0.005 * i, i == kMasses / 2 ? 0.001 : 0.0, 0.02 * string);
      network.mats.push_back(mat);
      if (i > 0) network.links.push_back({first + i - 1, first + i, 200.0, 0.001, 0.0045});
    }
  }
  return network;
}

NetworkDescription agglomerate(std::uint32_t balls) {
  const auto rows = static_cast<std::uint32_t>(std::max(2.0, std::floor(std::sqrt(balls))));
  const std::string text = fmt::format(
      "cordis: 1\nname: agglomerate\nspace: 2\nstep: {{rate_hz: 4000}}\n"
      "world: {{viscosity_n_s_per_m: 0.04}}\n"
      "liaisons:\n  clay:\n    viscosity_n_s_per_m: 0.1\n    elasticity:\n      kind: rings\n"
      "      rings:\n"
      "        - {{stiffness_n_per_m: 800, radius_m: 0.0045}}\n"
      "        - {{stiffness_n_per_m: 500, radius_m: 0.006}}\n"
      "        - {{stiffness_n_per_m: -200, radius_m: 0.0075}}\n"
      "matter:\n  paste: {{kind: lattice, structure: triangular, spacing_m: 0.005, corner_m: [0, "
      "0], "
      "counts: [{}, {}], ball: {{mass_kg: 0.001, radius_m: 0.0025}}}}\n"
      "links:\n  - {{liaison: clay, within: paste}}\n",
      std::max(2u, balls / rows), rows);
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(text, "agglomerate", problems);
  problems.throw_if_any();
  return scene.network;
}

}  // namespace cordis::cli
