// sim_node/port_brake.cpp
#include "sim_node/port_brake.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/plan/port_limit.h"

namespace cordis::sim {
namespace {

using Eigen::Matrix3d;
using engine::Vec3;

Matrix3d projection_on(const std::vector<Vec3>& directions) {
  Matrix3d projection = Matrix3d::Zero();
  for (const Vec3& direction : directions) {
    const Vec3 rest = direction - projection * direction;
    projection += rest * rest.transpose() / rest.squaredNorm();
  }
  return projection;
}

/// Of the medium and the linear links, as they lie at the start.
Matrix3d viscosity_at(const engine::NetworkDescription& network, std::uint32_t mat) {
  Matrix3d viscosity = network.medium_viscosity * Matrix3d::Identity();
  for (const engine::Link& link : network.links) {
    if (link.mat_a != mat && link.mat_b != mat) continue;
    const Vec3 along = network.mats[link.mat_b].position - network.mats[link.mat_a].position;
    if (link.isotropic || network.dimension == 1) {
      viscosity += link.viscosity * Matrix3d::Identity();
    } else if (along.squaredNorm() > 0.0) {
      viscosity += link.viscosity * along * along.transpose() / along.squaredNorm();
    }
  }
  return viscosity;
}

/// What a step bears beside the links of the port: with K' + 2 Z' of both ends of every link, and
/// twice its own, it stays below 4, and no braking turns the motion round.
double most_damping(const plan::PortLoad& load, double mass, double dt) {
  const double share = 2.0 - load.stiffness * dt * dt / mass - 2.0 * load.viscosity * dt / mass;
  return std::clamp(share, 0.0, 1.0) * mass / dt;
}

}  // namespace

PortBrake::PortBrake(const scene::Scene& scene, const std::vector<scene::Port>& ports)
    : dt_(scene.network.step),
      settled_after_(static_cast<int>(std::lround(kSettled * scene.gesture_rate_hz))),
      steps_per_tick_(1.0 / (scene.gesture_rate_hz * scene.network.step)),
      fading_(1.0 - 1.0 / std::max(1, settled_after_)) {
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  for (const scene::Port& port : ports) {
    Braked braked;
    braked.mat = port.mat;
    braked.axes = projection_on(port.directions);
    braked.viscosity = viscosity_at(scene.network, port.mat);
    braked.most =
        most_damping(plan::port_load(graph, port.mat), scene.network.mats[port.mat].mass, dt_);
    ports_.push_back(braked);
  }
  start();
}

void PortBrake::start() noexcept {
  ticks_ = 0;
  told_ = caught_ = false;
  account_ = strict_ = ripple_ = 0.0;
}

Vec3 PortBrake::brake(std::size_t port, const engine::World& world,
                      const Vec3& hand_force) noexcept {
  Braked& at = ports_[port];
  const Vec3 position = world.position(at.mat);
  if (!std::exchange(at.moves, true)) at.now = at.before = position;
  const Vec3 way = position - at.now;
  const Vec3 way_before = at.now - at.before;
  // f . (x(n+1) - x(n-1)) / 2, summed by ways instead of forces.
  sum_.brought += 0.5 * (hand_force + at.force).dot(way);
  ripple_ = std::max(ripple_, std::abs(hand_force.dot(way)) * steps_per_tick_);
  sum_.taken += 0.5 / dt_ * (at.viscosity * (way + way_before)).dot(way);
  strict_ += 0.5 * at.braking.dot(way + way_before);
  at.before = at.now;
  at.now = position;
  at.force = hand_force;
  at.braking = Vec3::Zero();
  const Vec3 moved = at.axes * way;
  if (strict_ <= 0.0 || moved.squaredNorm() == 0.0) return at.braking;
  const double damping = std::min(at.most, strict_ * dt_ / moved.squaredNorm());
  at.braking = -damping / dt_ * moved;
  braked_ = true;
  return at.braking;
}

void PortBrake::hear(double work_j, std::uint64_t answered_sample) noexcept {
  while (last_entered_ < newest_answer_) at_answer_[++last_entered_ % kRoom] = sum_;
  ++ticks_;
  if (std::exchange(braked_, false)) ++braked_ticks_;
  // A device that has not heard for so long is led on gradually when it hears again.
  if (answered_sample + kRoom <= last_entered_) start();
  const bool known = answered_sample != 0 && answered_sample <= last_entered_ &&
                     answered_sample + kRoom > last_entered_;
  if (!known || !std::isfinite(work_j)) return;
  const Account& then = at_answer_[answered_sample % kRoom];
  ripple_ *= fading_;
  const double made = then.brought - work_j;
  const double kept = made - kShare * then.taken;
  told_ = told_ || work_j != 0.0;
  if (told_ && ticks_ > settled_after_) {
    account_ = std::max(account_ + (kept - kept_before_), -kTank);
    if (caught_ && account_ < 0.0) {
      caught_ = false;
      strict_ = 0.0;
    } else if (caught_) {
      strict_ = std::max(strict_ + (made - made_before_), -kTank);
    } else if (account_ > kBudget + ripple_) {
      caught_ = true;
      strict_ = account_;
    }
  }
  made_before_ = made;
  kept_before_ = kept;
}

}  // namespace cordis::sim
