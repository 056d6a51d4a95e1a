// sim_node/devices/passivity_controller.cpp
#include "sim_node/devices/passivity_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim_node/checks/port_body.h"

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

/// What keeps a step stable beside the links of the port: with K' + 2 Z' of both ends of every
/// link, and twice its own, it stays below 4, and no damping turns the motion round.
double max_damping(const plan::PortLoad& load, double mass, double dt) {
  const double share = 2.0 - load.stiffness * dt * dt / mass - 2.0 * load.viscosity * dt / mass;
  return std::clamp(share, 0.0, 1.0) * mass / dt;
}

}  // namespace

PassivityController::PassivityController(const scene::Scene& scene,
                                         const std::vector<scene::Port>& ports,
                                         std::shared_ptr<DelayEnergyObserver> account)
    : account_(std::move(account)),
      dt_(scene.network.step),
      steps_per_tick_(1.0 / (scene.gesture_rate_hz * scene.network.step)),
      settled_ticks_(settled_ticks(scene)) {
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  for (const scene::Port& port : ports) {
    DampedPort damped;
    damped.port = port;
    damped.axes = projection_on(port.directions);
    damped.most = max_damping(max_load_of(graph, scene, port), mass_of(scene, port), dt_);
    ports_.push_back(damped);
  }
}

void PassivityController::start() noexcept {
  ticks_ = 0;
  reports_work_ = false;
  strict_ = 0.0;
}

Vec3 PassivityController::damping_force(std::size_t port, const engine::World& world,
                                        const Vec3& hand_force) noexcept {
  DampedPort& damped = ports_[port];
  const Vec3 position = position_of(world, damped.port);
  if (!std::exchange(damped.moves, true)) damped.now = damped.before = position;
  const Vec3 way = position - damped.now;
  const Vec3 way_before = damped.now - damped.before;
  // f . (x(n+1) - x(n-1)) / 2, summed by ways instead of forces.
  brought_ += 0.5 * (hand_force + damped.force).dot(way);
  moved_ = std::max(moved_, std::abs(hand_force.dot(way)) * steps_per_tick_);
  strict_ += 0.5 * damped.damping_force.dot(way + way_before);
  damped.before = damped.now;
  damped.now = position;
  damped.force = hand_force;
  damped.damping_force = Vec3::Zero();
  const Vec3 moved = damped.axes * way;
  if (strict_ <= 0.0 || moved.squaredNorm() == 0.0) return damped.damping_force;
  const double damping = std::min(damped.most, strict_ * dt_ / moved.squaredNorm());
  damped.damping_force = -damping / dt_ * moved;
  is_damping_ = true;
  return damped.damping_force;
}

/// Once a tick: what the work of hands whose force bends between two samples may be less than
/// their samples say [J].
double PassivityController::uncertainty() noexcept {
  double sum = 0.0;
  for (DampedPort& damped : ports_) {
    const double way = (damped.now - std::exchange(damped.place, damped.now)).norm();
    const Vec3 change = damped.force - std::exchange(damped.force_before, damped.force);
    const double bend = (change - std::exchange(damped.change, change)).norm();
    sum += bend * way / 8.0;
  }
  return sum;
}

void PassivityController::receive(double work_j, std::uint64_t answered_sample,
                                  double dissipated_j) noexcept {
  // After a reset the scene has answers long before those that samples still speak of.
  if (newest_answer_ > kRoom) last_entered_ = std::max(last_entered_, newest_answer_ - kRoom);
  while (last_entered_ < newest_answer_) brought_at_answer_[++last_entered_ % kRoom] = brought_;
  ++ticks_;
  if (std::exchange(is_damping_, false)) ++passivity_ticks_;
  const double moved = std::exchange(moved_, 0.0);
  const double uncertainty_j = uncertainty();
  // A device that has received nothing for so long is led on gradually when it receives again.
  const bool later = answered_sample > last_entered_;  // than any answer: no device received that
  if (!later && last_entered_ - answered_sample >= kRoom) start();
  const bool known = answered_sample != 0 && !later && last_entered_ - answered_sample < kRoom;
  if (!known || !std::isfinite(work_j)) return;
  reports_work_ = reports_work_ || work_j != 0.0;
  const auto ticks_late = static_cast<double>(last_entered_ - answered_sample);
  const double excess_j = brought_at_answer_[answered_sample % kRoom] - work_j;
  if (reports_work_ && static_cast<double>(ticks_) > settled_ticks_) {
    evaluate(excess_j - excess_before_, uncertainty_j, dissipated_j,
             moved * std::max(ticks_late, 1.0));
  }
  excess_before_ = excess_j;
}

void PassivityController::evaluate(double made_j, double uncertainty_j, double taken_j,
                                   double moved_j) noexcept {
  const bool made_energy = account_->makes_energy();
  account_->enter(made_j, uncertainty_j, taken_j, moved_j);
  if (!account_->makes_energy()) {
    strict_ = 0.0;
  } else {
    const double more = made_energy ? made_j : account_->excess_j();
    strict_ = std::max(strict_ + more, -DelayEnergyObserver::kTank);
  }
}

}  // namespace cordis::sim
