// cli/bench/plain_loop.cpp
#include "cli/bench/plain_loop.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace cordis::cli {
namespace {

template <int kAxes>
struct PlainMass {
  double position[kAxes];
  double delayed[kAxes];
  double force[kAxes];
  double dt2_over_mass;
};

struct PlainLink {
  std::uint32_t a;
  std::uint32_t b;
  double stiffness;
  double viscosity_over_dt;
  double rest_length;
};

template <int kAxes>
[[gnu::always_inline]] inline void add_force(const PlainLink& link,
                                             PlainMass<kAxes>* masses) noexcept {
  PlainMass<kAxes>& a = masses[link.a];
  PlainMass<kAxes>& b = masses[link.b];
  double along[kAxes];
  double square = 0.0;
  double along_moved = 0.0;
  for (int axis = 0; axis < kAxes; ++axis) {
    along[axis] = b.position[axis] - a.position[axis];
    square += along[axis] * along[axis];
    along_moved += along[axis] * (along[axis] - (b.delayed[axis] - a.delayed[axis]));
  }
  const double length = kAxes == 1 ? along[0] : std::sqrt(square);
  if (length == 0.0) return;
  const double inverse = 1.0 / length;
  const double tension =
      link.stiffness * (length - link.rest_length) + link.viscosity_over_dt * along_moved * inverse;
  for (int axis = 0; axis < kAxes; ++axis) {
    const double force = kAxes == 1 ? tension : tension * inverse * along[axis];
    a.force[axis] += force;
    b.force[axis] -= force;
  }
}

template <int kAxes>
[[gnu::always_inline]] inline void step_all(const std::vector<PlainLink>& links,
                                            std::vector<PlainMass<kAxes>>& masses) noexcept {
  for (const PlainLink& link : links) add_force(link, masses.data());
  for (PlainMass<kAxes>& mass : masses) {
    for (int axis = 0; axis < kAxes; ++axis) {
      const double next =
          2.0 * mass.position[axis] - mass.delayed[axis] + mass.dt2_over_mass * mass.force[axis];
      mass.delayed[axis] = mass.position[axis];
      mass.position[axis] = next;
      mass.force[axis] = 0.0;
    }
  }
}

template <int kAxes>
void add_masses(const engine::NetworkDescription& network, std::vector<PlainMass<kAxes>>& masses) {
  for (const engine::Mat& mat : network.mats) {
    PlainMass<kAxes> mass{};
    for (int axis = 0; axis < kAxes; ++axis) {
      mass.position[axis] = mass.delayed[axis] = mat.position[axis];
    }
    mass.dt2_over_mass = network.step * network.step / mat.mass;
    masses.push_back(mass);
  }
}

}  // namespace

struct PlainLoop::State {
  int dimension;
  std::vector<PlainLink> links;
  std::vector<PlainMass<1>> masses_1d;
  std::vector<PlainMass<2>> masses_2d;
  std::vector<PlainMass<3>> masses_3d;
};

namespace {

#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
void step_on_any(PlainLoop::State& state) noexcept {
  if (state.dimension == 1) step_all(state.links, state.masses_1d);
  if (state.dimension == 2) step_all(state.links, state.masses_2d);
  if (state.dimension == 3) step_all(state.links, state.masses_3d);
}

}  // namespace

PlainLoop::PlainLoop(const engine::NetworkDescription& network)
    : state_(std::make_unique<State>(State{network.dimension, {}, {}, {}, {}})) {
  for (const engine::Link& link : network.links) {
    state_->links.push_back(
        {link.mat_a, link.mat_b, link.stiffness, link.viscosity / network.step, link.rest_length});
  }
  if (network.dimension == 1) add_masses(network, state_->masses_1d);
  if (network.dimension == 2) add_masses(network, state_->masses_2d);
  if (network.dimension == 3) add_masses(network, state_->masses_3d);
}

PlainLoop::~PlainLoop() = default;

void PlainLoop::step() noexcept {
  step_on_any(*state_);
}

double PlainLoop::position(std::size_t mass, int axis) const noexcept {
  if (state_->dimension == 1) return state_->masses_1d[mass].position[axis];
  if (state_->dimension == 2) return state_->masses_2d[mass].position[axis];
  return state_->masses_3d[mass].position[axis];
}

}  // namespace cordis::cli
